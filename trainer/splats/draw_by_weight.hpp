// A random choice of splats by weight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "trainer/common/random.hpp"

namespace tureen::trainer {

/// Up to `count` indices with a weight above 0, drawn one after the other without replacement, with
/// probabilities in proportion to the weights: the smallest of exponential variables with these
/// rates (Efraimidis and Spirakis 2006). Sorted, since the order that nth_element() leaves depends
/// on the library.
inline std::vector<std::uint32_t> draw_by_weight(Random& random, std::span<const float> weights,
                                                 std::size_t count) {
  std::vector<std::pair<double, std::uint32_t>> keys;
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    const double key = -std::log(1 - random.uniform()) / double(weights[i]);
    if (weights[i] > 0) keys.emplace_back(key, i);
  }
  count = std::min(count, keys.size());
  std::nth_element(keys.begin(), keys.begin() + std::ptrdiff_t(count), keys.end());
  std::vector<std::uint32_t> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back(keys[k].second);
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace tureen::trainer
