// The half spaces that bound an image's pyramid. Included once for each target of Highway.
#if defined(TUREEN_IMAGE_SIDES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_IMAGE_SIDES_INL
#undef TUREEN_IMAGE_SIDES_INL
#else
#define TUREEN_IMAGE_SIDES_INL
#endif

#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// Whether splats reach all of the four half spaces; others cover no pixel. `largest(normal)` is
/// the largest dot product of a normal with the homogeneous image points of a splat, in pixels from
/// the principal point.
template <class Largest>
HWY_INLINE Mask reach_image(const ImageView& view, const Largest& largest) {
  const auto reach = [&](float x, float y, float z) {
    return hn::Ge(largest(Vector3{constant(x), constant(y), constant(z)}), hn::Zero(d));
  };
  const Mask columns = hn::And(reach(1, 0, view.cx), reach(-1, 0, float(view.width) - view.cx));
  const Mask rows = hn::And(reach(0, 1, view.cy), reach(0, -1, float(view.height) - view.cy));
  return hn::And(columns, rows);
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
