#include "jobs/baseline/splat_baseline_order.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace tureen {

std::span<const std::uint32_t> SplatBaselineOrder::sort(std::span<const glm::vec3> centers,
                                                        const FrameCamera& camera) {
  constexpr std::size_t keys = 1 << 16;
  const glm::dvec3 backwards = glm::transpose(glm::dmat3(camera.camera.view_from_world))[2];
  // In double precision, no finite centre has an infinite depth.
  depths_.resize(centers.size());
  double nearest = std::numeric_limits<double>::max(), farthest = -nearest;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    depths_[i] = -glm::dot(backwards, glm::dvec3(centers[i]));
    nearest = std::min(nearest, depths_[i]);
    farthest = std::max(farthest, depths_[i]);
  }
  const double scale = farthest > nearest ? double(keys - 1) / (farthest - nearest) : 0.0;
  keys_.resize(centers.size());
  starts_.assign(keys + 1, 0);
  for (std::size_t i = 0; i < centers.size(); ++i) {
    keys_[i] = static_cast<std::uint16_t>((farthest - depths_[i]) * scale);
    ++starts_[keys_[i] + std::size_t(1)];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  order_.resize(centers.size());
  for (std::size_t i = 0; i < centers.size(); ++i)
    order_[starts_[keys_[i]]++] = static_cast<std::uint32_t>(i);
  return order_;
}

}  // namespace tureen
