// The order in which splats are blended: by the view depth of their centres, near ones first.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "splatting/depth_order.hpp"

namespace tureen {

/// Splats of one layer and the view depth of a centre: dot(axis, center) - offset.
struct SplatsInView {
  std::span<const glm::vec3> centers;
  glm::dvec3 axis;
  double offset = 0;
  float fraction = 1;  // of the splats; a hash of the index chooses them
  /// For each chunk of splats_per_chunk centres, whether it is left out of the order. Empty: none.
  std::vector<bool> behind = {};
  /// For each chunk, whether it is outside the image. A superset of `behind`.
  std::vector<bool> outside = {};

  bool skips(std::size_t chunk) const { return chunk < behind.size() && behind[chunk]; }
};

/// Whether the order for the views `sorted` also serves `views`: it is their order, and has at
/// least their splats.
bool serves(std::span<const SplatsInView> sorted, std::span<const SplatsInView> views);
/// Whether that order has at least the splats of `views` that are inside the image.
bool has_visible_splats_of(std::span<const SplatsInView> sorted,
                           std::span<const SplatsInView> views);

/// In radians: 2 degrees. The image of a dense scene differs by 50 to 55 dB from that in its own
/// order; with 5 degrees it is 44 dB, which is visible.
inline constexpr double max_order_lag = 0.0349;
/// Whether the viewing axes differ by at most max_order_lag.
bool lags_little(std::span<const SplatsInView> sorted, std::span<const SplatsInView> views);

using splatting::SplatRun;

class SplatOrder : public splatting::DepthOrder {
 public:
  using DepthOrder::DepthOrder;
  /// Sorts the splats of all layers together. The depth is computed in double precision and rounded
  /// to a float.
  void sort(std::span<const SplatsInView> layers);
};

}  // namespace tureen
