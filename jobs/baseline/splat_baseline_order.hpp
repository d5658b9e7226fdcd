// The order of the plain baseline for splats: a counting sort of view depths in 16 bits.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "runtime/passes/pass.hpp"

namespace tureen {

class SplatBaselineOrder {
 public:
  /// The indices of the centres, which are finite, far ones first. Depths are rounded to 2^16 steps
  /// between the nearest and the farthest centre. Valid until the next call.
  std::span<const std::uint32_t> sort(std::span<const glm::vec3> centers,
                                      const FrameCamera& camera);

 private:
  std::vector<double> depths_;
  std::vector<std::uint16_t> keys_;
  std::vector<std::uint32_t> starts_, order_;
};

}  // namespace tureen
