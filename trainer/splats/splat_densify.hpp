// Densification of splats of any kernel: those that no image needs take the places of parts of
// others, and their number grows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scene/region.hpp"
#include "trainer/common/random.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/splat_order.hpp"

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

struct DensifyLimits {
  std::size_t max_splats;
  double growth;                 // largest, a fraction of the number of splats
  std::size_t min_growth = 100;  // but at least this, up to twice the number
  float min_opacity;             // below: dead
};

struct DensifyReport {
  std::size_t dead = 0;   // of them, as many are relocated as there are parents
  std::size_t split = 0;  // splats that were split into two
};

/// A splat is dead if it was not evident in any step since the last call, or its opacity is low, or
/// it is not finite. Parents are drawn without replacement from the others, by `weight`(splat):
/// `split`(parent, place) puts the first child into the parent's place, and the second one into
/// that of a dead splat or a new one. The moments of children begin at 0, and so do all statistics
/// except the steps of other splats. If all splats are dead, or none has a weight, nothing changes.
template <class Parameters, class Weight, class Split>
DensifyReport densify_splats(const DensifyLimits& limits, Random& random, Parameters& parameters,
                             SplatMemory& memory, const Weight& weight, const Split& split) {
  const std::size_t count = parameters.count();
  std::vector<float> weights(count);  // 0: dead
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool alive = memory.statistics.row(splat_statistic::evident)[i] > 0 &&
                       parameters.opacity(i) >= limits.min_opacity && parameters.is_finite(i);
    if (alive)
      weights[i] = weight(i);
    else
      places.push_back(i);
  }
  DensifyReport report{.dead = places.size()};
  const std::size_t growth =
      std::max(std::size_t(limits.growth * double(count)), std::min(count, limits.min_growth));
  const std::size_t target = std::max(count, std::min(limits.max_splats, count + growth));
  const std::vector<std::uint32_t> parents =
      draw_by_weight(random, weights, places.size() + (target - count));
  report.split = parents.size();
  if (parents.size() > places.size()) {
    const std::size_t larger = count + parents.size() - places.size();
    parameters.enlarge(larger);
    memory.enlarge(larger);
    for (std::size_t i = count; i < larger; ++i) places.push_back(std::uint32_t(i));
  }
  for (std::size_t k = 0; k < parents.size(); ++k) {
    split(parents[k], places[k]);
    parameters.activate(parents[k]);
    parameters.activate(places[k]);
    memory.reset(parents[k]);
    memory.reset(places[k]);
  }
  for (const std::size_t which : {splat_statistic::motion, splat_statistic::evident})
    std::fill_n(memory.statistics.row(which), parameters.count(), 0.0f);
  return report;
}

/// Sorts the splats in memory by morton_order() of their centres. `region`: the cube with most of
/// them.
template <class Parameters>
void sort_in_memory(const Region& region, Parameters& parameters, SplatMemory& memory) {
  std::vector<glm::vec3> centers;
  for (std::size_t i = 0; i < parameters.count(); ++i) centers.push_back(parameters.center(i));
  const std::vector<std::uint32_t> order = morton_order(centers, region);
  parameters.reorder(order);
  memory.reorder(order);
}

}  // namespace tureen::trainer
