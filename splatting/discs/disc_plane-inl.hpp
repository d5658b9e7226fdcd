// The planes of discs in the image. Included once for each target of Highway.
#if defined(TUREEN_DISC_PLANE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_DISC_PLANE_INL
#undef TUREEN_DISC_PLANE_INL
#else
#define TUREEN_DISC_PLANE_INL
#endif

#include "splatting/image_view.hpp"
#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// The map of a disc's plane into the image, as projected_disc_row: (u, v, 1) to homogeneous pixels
/// from an origin.
struct DiscPlane {
  Floats x, y;  // the origin
  Vector3 of_x, of_y, of_w;
};

/// Of the disc with this centre and axes of one deviation, in view coordinates.
HWY_INLINE DiscPlane plane_of(const ImageView& view, const Vector3& center, const Vector3& u,
                              const Vector3& v, Mask in_front) {
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  const Floats fx = constant(view.fx), fy = constant(view.fy);
  const Floats scale = hn::Div(one, hn::IfThenElse(in_front, center.z, one));
  const Floats slope_x = hn::IfThenElseZero(in_front, hn::Mul(center.x, scale));
  const Floats slope_y = hn::IfThenElseZero(in_front, hn::Mul(center.y, scale));
  return {hn::MulAdd(fx, slope_x, constant(view.cx)), hn::MulAdd(fy, slope_y, constant(view.cy)),
          Vector3{hn::Mul(fx, hn::NegMulAdd(slope_x, u.z, u.x)),
                  hn::Mul(fx, hn::NegMulAdd(slope_x, v.z, v.x)),
                  hn::IfThenElse(in_front, zero, hn::Mul(fx, center.x))},
          Vector3{hn::Mul(fy, hn::NegMulAdd(slope_y, u.z, u.y)),
                  hn::Mul(fy, hn::NegMulAdd(slope_y, v.z, v.y)),
                  hn::IfThenElse(in_front, zero, hn::Mul(fy, center.y))},
          Vector3{u.z, v.z, center.z}};
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
