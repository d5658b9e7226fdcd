// Gaussians and discs on rays. Included once for each target of Highway.
//
// With the local axes r_k, the variances S_k, the centre m relative to the ray's origin, the unit
// direction d, b_k = r_k . d and c_k = r_k . (m x d), the exponent of the largest density on the
// ray is -q / 2, and its distance t, with
//   w = b_1^2 S_2 S_3 + b_2^2 S_3 S_1 + b_3^2 S_1 S_2
//   q = (c_1^2 S_1 + c_2^2 S_2 + c_3^2 S_3) / w
//   t = (b_1 (r_1 . m) S_2 S_3 + ..) / w.
// No term of q cancels, and nothing is divided by a variance: with S_3 = 0, the point on the ray is
// that of the disc's plane. w is the determinant of the covariance across the ray.
#if defined(TUREEN_ELLIPSOID_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_ELLIPSOID_INL
#undef TUREEN_ELLIPSOID_INL
#else
#define TUREEN_ELLIPSOID_INL
#endif

#include "tracing/bvh/traverse-inl.hpp"
#include "tracing/kernels/ellipsoid.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::tracing::HWY_NAMESPACE {

/// log2(e) / 2: exp(-q / 2) = 2^-(factor q).
inline constexpr float half_log2_e = 0.721347520f;

/// `Splat` of collect_on() by a profile with or without dilation, or with the filter on the screen.
template <bool flat>
class EllipsoidOnRay {
 public:
  HWY_INLINE EllipsoidOnRay(const TracedLayer& layer, const RayInLayer& ray)
      : ray_(ray),
        profile_(std::get<Splats>(layer.primitives()).profile),
        limits_(profile_),
        dilation_(float(dilation_of(profile_))),
        screen_(profile_.low_pass == SplatProfile::LowPass::screen ? float(screen_variance) : 0.0f),
        keeps_integral_(profile_.low_pass == SplatProfile::LowPass::mip) {}

  HWY_INLINE Mask at(const Block& block, Floats& distance, Floats& alpha) const {
    namespace row = ellipsoid_row;
    const Vector3 along = of_ray(ray_.along);
    const Vector3 center = from_origin(ray_, block.rows(row::center));
    const Vector3 moment = cross(center, along);
    Vector3 variance = block.rows(row::variances);
    const Floats zero = hn::Zero(d);
    Floats to_center = zero, footprint = zero;  // the squared width of the pixel at the centre
    if (dilation_ > 0 || screen_ > 0) {
      to_center = dot(center, along);
      const Floats path = hn::Add(constant(ray_.path), hn::Max(to_center, zero));
      const Floats pixel = hn::Mul(path, constant(ray_.pixel));
      footprint = hn::Mul(pixel, pixel);
    }
    Floats axis_along[3], axis_center[3], squared_moment[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 axis = block.rows(row::axes + 3 * k);
      axis_along[k] = dot(axis, along);
      axis_center[k] = dot(axis, center);
      const Floats across = dot(axis, moment);
      squared_moment[k] = hn::Mul(across, across);
    }
    const Vector3 squared_along{hn::Mul(axis_along[0], axis_along[0]),
                                hn::Mul(axis_along[1], axis_along[1]),
                                hn::Mul(axis_along[2], axis_along[2])};
    const auto section = [&](const Vector3& products) { return dot(squared_along, products); };
    const auto pairs = [](const Vector3& v) {
      return Vector3{hn::Mul(v.y, v.z), hn::Mul(v.z, v.x), hn::Mul(v.x, v.y)};
    };
    Floats log_opacity = block.row(row::log_opacity);
    Vector3 products = pairs(variance);
    Floats before = zero;
    if (dilation_ > 0) {
      if (keeps_integral_) before = section(products);
      const Floats more = hn::Mul(footprint, constant(dilation_));
      variance = {hn::Add(variance.x, more), hn::Add(variance.y, more), hn::Add(variance.z, more)};
      products = pairs(variance);
    }
    const Floats across = section(products), by_across = hn::Div(constant(1.0f), across);
    if (keeps_integral_) {
      // The opacity times sqrt(before / across). Below 1e-38, alpha is below any limit.
      const Floats kept = hn::Max(hn::Mul(before, by_across), constant(1e-38f));
      log_opacity = hn::MulAdd(constant(0.5f), log2_of(kept), log_opacity);
    }
    Floats squared = hn::Mul(
        dot({squared_moment[0], squared_moment[1], squared_moment[2]}, variance), by_across);
    // False for NaN: seen edge-on and without a dilation.
    Mask met = hn::Lt(squared, constant(1e30f));
    distance =
        hn::Mul(dot({hn::Mul(axis_along[0], axis_center[0]), hn::Mul(axis_along[1], axis_center[1]),
                     hn::Mul(axis_along[2], axis_center[2])},
                    products),
                by_across);
    met = hn::And(met, hn::Gt(distance, zero));
    if (flat && screen_ > 0) {
      // Where the plane is not met, in front of the eye, only this filter remains.
      squared = hn::IfThenElse(met, squared, constant(1e30f));
      const Floats filtered = hn::Div(dot(moment, moment), hn::Mul(footprint, constant(screen_)));
      const Mask is_filtered = hn::And(hn::Lt(filtered, squared), hn::Gt(to_center, zero));
      squared = hn::IfThenElse(is_filtered, filtered, squared);
      distance = hn::IfThenElse(is_filtered, to_center, distance);
      met = hn::Or(met, is_filtered);
    }
    const Floats log_alpha = hn::NegMulAdd(constant(half_log2_e), squared, log_opacity);
    met = hn::And(met, hn::Ge(log_alpha, constant(limits_.least_log)));
    met = hn::And(met, hn::Lt(distance, constant(ray_.end)));
    if (none(met)) return met;
    alpha = hn::Min(exp2_of(hn::Max(log_alpha, constant(limits_.least_log))),
                    constant(limits_.largest));
    return met;
  }

 private:
  const RayInLayer& ray_;
  const SplatProfile& profile_;
  AlphaLimits limits_;
  float dilation_, screen_;
  bool keeps_integral_;
};

}  // namespace tureen::tracing::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
