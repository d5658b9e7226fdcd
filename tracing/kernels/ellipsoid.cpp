#include "tracing/kernels/ellipsoid.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::tracing {

namespace {

const Gaussians& gaussians_of(const Primitives& primitives) {
  return std::get<Gaussians>(std::get<Splats>(primitives).kernel);
}

}  // namespace

double dilation_of(const SplatProfile& profile) {
  const bool dilates = profile.low_pass == SplatProfile::LowPass::dilation ||
                       profile.low_pass == SplatProfile::LowPass::mip;
  return dilates ? dilation_variance : 0.0;
}

bool are_gaussians(const Primitives& primitives, SplatProfile::Projection projection) {
  const auto* splats = std::get_if<Splats>(&primitives);
  return splats && std::holds_alternative<Gaussians>(splats->kernel) &&
         splats->profile.projection == projection;
}

std::size_t ellipsoid_count(const Primitives& primitives) {
  return gaussians_of(primitives).centers.size();
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

}  // namespace tureen::tracing
