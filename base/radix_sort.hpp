// Sorting of indices by 32-bit keys, in O(n).
#pragma once

#include <cstdint>
#include <vector>

namespace tureen {

struct KeyedIndex {
  std::uint32_t key;
  std::uint32_t index;
};

/// Keys of floats in the order of their values. -0 and 0 have the same key, so that ties stay ties.
/// Not for NaN.
std::uint32_t sort_key(float value);

/// Sorts by key; equal keys keep their order. `scratch` is memory for later calls.
void radix_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& scratch);

}  // namespace tureen
