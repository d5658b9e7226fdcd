// Stable sorting by view depth.
#pragma once

#include <cstdint>
#include <vector>

namespace tureen::splatting {

/// A splat and the key of its depth.
struct DepthKey {
  std::uint32_t key;
  std::uint32_t splat;
};

/// Unsigned integers in the order of the floats. -0 equals 0, so that ties stay ties. Not for NaN.
std::uint32_t depth_key(float depth);

/// Sorts by key, and keeps the order of equal keys. `scratch` is memory for later calls.
void sort_by_depth(std::vector<DepthKey>& keys, std::vector<DepthKey>& scratch);

}  // namespace tureen::splatting
