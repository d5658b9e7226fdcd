// Rotations of splats. Included once for each target of Highway.
#if defined(TUREEN_ROTATION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_ROTATION_INL
#undef TUREEN_ROTATION_INL
#else
#define TUREEN_ROTATION_INL
#endif

#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// The local axes of a splat, in layer coordinates.
struct Rotation {
  Vector3 axes[3];
};

/// Of a unit quaternion.
HWY_INLINE Rotation rotation_of(Floats x, Floats y, Floats z, Floats w) {
  const Floats dx = hn::Add(x, x), dy = hn::Add(y, y), dz = hn::Add(z, z), one = constant(1.0f);
  const Floats xx = hn::Mul(dx, x), yy = hn::Mul(dy, y), zz = hn::Mul(dz, z);
  const Floats xy = hn::Mul(dx, y), xz = hn::Mul(dx, z), yz = hn::Mul(dy, z);
  const Floats wx = hn::Mul(dx, w), wy = hn::Mul(dy, w), wz = hn::Mul(dz, w);
  return {{{hn::Sub(hn::Sub(one, yy), zz), hn::Add(xy, wz), hn::Sub(xz, wy)},
           {hn::Sub(xy, wz), hn::Sub(hn::Sub(one, xx), zz), hn::Add(yz, wx)},
           {hn::Add(xz, wy), hn::Sub(yz, wx), hn::Sub(hn::Sub(one, xx), yy)}}};
}

/// The range of one image coordinate of the quadric {H x + H_c : |x| <= 1}, relative to the centre.
/// `along` are the coordinates of H's columns and `w` their depths; `center_w` is the depth of the
/// centre, and the quadric lies in front of the eye.
HWY_INLINE void range_of(const Vector3& along, const Vector3& w, Floats center_w, Floats& low,
                         Floats& high) {
  // Relative to the depth: fourth powers of lengths overflow beyond 1e9 (docs/numerics.md, E8).
  const Floats by_depth = hn::Div(constant(1.0f), center_w);
  const auto relative = [&](const Vector3& v) {
    return Vector3{hn::Mul(v.x, by_depth), hn::Mul(v.y, by_depth), hn::Mul(v.z, by_depth)};
  };
  const Vector3 p = relative(along), q = relative(w);
  const Floats a = hn::Sub(dot(q, q), constant(1.0f));  // < 0
  const Floats b = dot(p, q);
  const Floats root = hn::Sqrt(hn::Max(hn::NegMulAdd(a, dot(p, p), hn::Mul(b, b)), hn::Zero(d)));
  low = hn::Div(hn::Add(b, root), a);
  high = hn::Div(hn::Sub(b, root), a);
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
