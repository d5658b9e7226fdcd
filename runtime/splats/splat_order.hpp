// The order in which splats are blended: by the view depth of their centres, near ones first.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "base/radix_sort.hpp"

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

/// Consecutive splats of one layer in an order.
struct SplatRun {
  std::uint32_t layer = 0;  // index into the sorted layers
  std::uint32_t first = 0;  // in the order
  std::uint32_t count = 0;
};

class SplatOrder {
 public:
  SplatOrder() = default;
  /// An order that another SplatOrder made.
  SplatOrder(std::vector<std::uint32_t> splats, std::vector<SplatRun> runs)
      : splats_(std::move(splats)), runs_(std::move(runs)) {}

  /// Sorts the splats of all layers together. The depth is computed in double precision and rounded
  /// to a float. At equal depth the earlier layer comes first, then the lower index. Splats without
  /// a finite depth are dropped.
  void sort(std::span<const SplatsInView> layers);

  /// Indices in their layers, near ones first.
  std::span<const std::uint32_t> splats() const { return splats_; }
  /// The order in runs, from near to far.
  std::span<const SplatRun> runs() const { return runs_; }

 private:
  void make_runs(std::span<const SplatsInView> layers);

  /// The index is that of the splat if the layers are numbered consecutively.
  std::vector<KeyedIndex> entries_, scratch_;
  std::vector<std::uint32_t> splats_;
  std::vector<SplatRun> runs_;
};

}  // namespace tureen
