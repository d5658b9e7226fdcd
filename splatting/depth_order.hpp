// The order in which the splats of all layers of a frame are blended: by view depth, near ones
// first. At equal depth the earlier layer comes first, then the lower index.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/radix_sort.hpp"

namespace tureen::splatting {

/// Consecutive splats of one layer in an order.
struct SplatRun {
  std::uint32_t layer = 0;  // by the number of add_layer() calls before its own
  std::uint32_t first = 0;  // in the order
  std::uint32_t count = 0;
};

/// Call begin(), add_layer() for each layer, sort(), and make_runs() for splats() and runs().
class DepthOrder {
 public:
  DepthOrder() = default;
  /// An order that another DepthOrder made.
  DepthOrder(std::vector<std::uint32_t> splats, std::vector<SplatRun> runs)
      : splats_(std::move(splats)), runs_(std::move(runs)) {}

  void begin() {
    entries_.clear();
    ends_.clear();
  }
  /// `depth(i)` is the view depth of splat i in the unit of all layers, as a float. Splats whose
  /// depth is not finite are omitted.
  template <class Depth>
  void add_layer(std::size_t count, const Depth& depth) {
    const std::uint32_t first = ends_.empty() ? 0 : ends_.back();
    for (std::uint32_t i = 0; i < count; ++i)
      if (const float value = depth(i); std::isfinite(value))
        entries_.push_back({sort_key(value), first + i});
    ends_.push_back(first + static_cast<std::uint32_t>(count));
  }
  void sort() { radix_sort(entries_, scratch_); }
  void make_runs();

  /// After sort(): near ones first. The index numbers the splats of all layers consecutively.
  std::span<const KeyedIndex> entries() const { return entries_; }
  /// After make_runs(): indices in their layers, near ones first.
  std::span<const std::uint32_t> splats() const { return splats_; }
  /// The order in runs, from near to far.
  std::span<const SplatRun> runs() const { return runs_; }

 private:
  std::vector<KeyedIndex> entries_, scratch_;
  std::vector<std::uint32_t> ends_;  // of the layers' numbers
  std::vector<std::uint32_t> splats_;
  std::vector<SplatRun> runs_;
};

}  // namespace tureen::splatting
