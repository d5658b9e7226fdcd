// Gaussians and discs (flat Gaussians on their plane: 2DGS, REdiSplats) on rays
// (tracing/kernels/ray_kernel.hpp).
//
// With the local axes r_k, the variances S_k, the centre m relative to the ray's origin, the unit
// direction d, b_k = r_k . d and c_k = r_k . (m x d), the exponent of the largest density on the
// ray is -q / 2, and its distance t, with
//   w = b_1^2 S_2 S_3 + b_2^2 S_3 S_1 + b_3^2 S_1 S_2
//   q = (c_1^2 S_1 + c_2^2 S_2 + c_3^2 S_3) / w
//   t = (b_1 (r_1 . m) S_2 S_3 + ..) / w.
// No term of q cancels, and nothing is divided by a variance: with S_3 = 0, the point on the ray is
// that of the disc's plane. w is the determinant of the covariance across the ray.
#include <cmath>

#include "tracing/kernels/ray_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracing/kernels/ellipsoid_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tracing/bvh/traverse-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::tracing::HWY_NAMESPACE {

/// The rows of a block, in layer units.
namespace ellipsoid_row {
enum : std::size_t {
  center = 0,
  axes = 3,  // three unit vectors
  variances = 12,
  log_opacity = 15,  // to the base 2
  count
};
}

/// SplatProfile::low_pass in squared widths of a pixel; 0: none.
inline double dilation_of(const SplatProfile& profile) {
  const bool dilates = profile.low_pass == SplatProfile::LowPass::dilation ||
                       profile.low_pass == SplatProfile::LowPass::mip;
  return dilates ? dilation_variance : 0.0;
}

/// log2(e) / 2: exp(-q / 2) = 2^-(factor q).
inline constexpr float half_log2_e = 0.721347520f;

/// `Splat` of collect_on() by a profile with or without dilation, or with the filter on the screen.
template <bool flat>
class EllipsoidOnRay : private SplatOfRay {
 public:
  HWY_INLINE EllipsoidOnRay(const TracedLayer& layer, const RayInLayer& ray)
      : SplatOfRay(layer, ray),
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
  float dilation_, screen_;
  bool keeps_integral_;
};

constexpr auto& collect_gaussians = collect_on<EllipsoidOnRay<false>>;
constexpr auto& collect_discs = collect_on<EllipsoidOnRay<true>>;

}  // namespace tureen::tracing::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::tracing {

HWY_EXPORT(collect_gaussians);
HWY_EXPORT(collect_discs);

namespace {

using HWY_NAMESPACE::dilation_of;
namespace ellipsoid_row = HWY_NAMESPACE::ellipsoid_row;

const Gaussians& gaussians_of(const Primitives& primitives) {
  return std::get<Gaussians>(std::get<Splats>(primitives).kernel);
}

/// Whether the primitives are Gaussians that this projection draws.
bool are_gaussians(const Primitives& primitives, SplatProfile::Projection projection) {
  const auto* splats = std::get_if<Splats>(&primitives);
  return splats && std::holds_alternative<Gaussians>(splats->kernel) &&
         splats->profile.projection == projection;
}

void pack_ellipsoid(const Primitives& primitives, std::size_t i, float* lane) {
  namespace row = ellipsoid_row;
  const Gaussians& gaussians = gaussians_of(primitives);
  const glm::quat& q = gaussians.rotations[i];
  const float by_length = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  const float x = q.x * by_length, y = q.y * by_length, z = q.z * by_length, w = q.w * by_length;
  const float axes[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),
                         2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
                         2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};
  const glm::vec3& scales = gaussians.scales[i];
  for (int k = 0; k < 3; ++k) {
    lane[width * (row::center + std::size_t(k))] = gaussians.centers[i][k];
    const float scale = gaussians.flat && k == 2 ? 0.0f : scales[k];
    lane[width * (row::variances + std::size_t(k))] = scale * scale;
  }
  for (std::size_t k = 0; k < 9; ++k) lane[width * (row::axes + k)] = axes[k];
  lane[width * row::log_opacity] = std::log2(gaussians.opacity[i]);  // of 0: -infinity
}

Box ellipsoid_box(const Primitives& primitives, const float* lane) {
  namespace row = ellipsoid_row;
  const auto value = [&](std::size_t which) { return lane[width * which]; };
  const SplatProfile& profile = std::get<Splats>(primitives).profile;
  constexpr float twice_ln_2 = 1.38629436f;
  const float squared = twice_ln_2 * (value(row::log_opacity) - std::log2(profile.min_alpha));
  if (!(squared >= 0)) return {};
  // Alpha is computed to about 1e-6: the box of 0.1 % more has no wrong rim.
  const float reach = squared * 1.001f + 1e-3f;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    float sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const float component = value(row::axes + 3 * k + std::size_t(axis));
      sum += component * component * value(row::variances + k);
    }
    const float extent = std::sqrt(reach * sum), center = value(row::center + std::size_t(axis));
    // Not a finite number: the box is not usable.
    box.low[axis] = center - extent;
    box.high[axis] = center + extent;
  }
  return box;
}

float ellipsoid_footprint(const Primitives& primitives) {
  const SplatProfile& profile = std::get<Splats>(primitives).profile;
  const double variance =
      profile.low_pass == SplatProfile::LowPass::screen ? screen_variance : dilation_of(profile);
  return float(std::sqrt(1.001 * double(largest_squared(1.0f, profile)) * variance));
}

constexpr RayKernel ellipsoid_kernel(bool (*draws)(const Primitives&),
                                     CollectSplats* (*collect)()) {
  return {
      .draws = draws,
      .count = [](const Primitives& primitives) { return gaussians_of(primitives).centers.size(); },
      .rows = ellipsoid_row::count,
      .pack = pack_ellipsoid,
      .unused = -std::numeric_limits<float>::infinity(),
      .box = ellipsoid_box,
      .footprint = ellipsoid_footprint,
      .collect = collect,
      .color = splat_color};
}

}  // namespace

constexpr RayKernel gaussian_rays = ellipsoid_kernel(
    [](const Primitives& primitives) {
      return are_gaussians(primitives, SplatProfile::Projection::ewa);
    },
    []() -> CollectSplats* { return HWY_DYNAMIC_DISPATCH(collect_gaussians); });
constexpr RayKernel disc_rays = ellipsoid_kernel(
    [](const Primitives& primitives) {
      return are_gaussians(primitives, SplatProfile::Projection::plane);
    },
    []() -> CollectSplats* { return HWY_DYNAMIC_DISPATCH(collect_discs); });

}  // namespace tureen::tracing
#endif
