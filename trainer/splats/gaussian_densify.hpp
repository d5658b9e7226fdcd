// Densification of Gaussians: splats whose images move much are split. Their children take the
// places of splats that no image needs, or are added.
#pragma once

#include <cstddef>

#include "trainer/common/random.hpp"
#include "trainer/common/region.hpp"
#include "trainer/splats/gaussian_step_kernels.hpp"

namespace tureen::trainer {

struct DensifyOptions {
  std::size_t max_splats;
  double growth = 0.15;          // largest, a fraction of the number of splats
  std::size_t min_growth = 100;  // but at least this, up to twice the number
  float min_opacity = 0.01f;     // below: dead
  float distance = 0.75f;        // of children from their parent's centre, in standard deviations
  float shrink_along = 1.8f;     // divides the children's scale along the longest axis
  float shrink_across = 1.1f;    // and along the others
};

struct DensifyReport {
  std::size_t dead = 0;   // of them, as many are relocated as there are parents
  std::size_t split = 0;  // splats that were split into two
};

/// A splat is dead if it was not evident in any step since the last call, or its opacity is low.
/// Parents are drawn without replacement from the others, by splat_statistic::motion: the first
/// child takes the parent's place, the second one that of a dead splat or a new one. The moments of
/// children begin at 0, and so do all statistics except the steps of other splats. Splats that are
/// not finite are dead. If all splats are dead, or none moves, nothing changes.
DensifyReport densify(const DensifyOptions& options, Random& random, GaussianParameters& parameters,
                      SplatMemory& memory);

/// Sorts the splats in memory by morton_order() of their centres. `region`: the cube with most of
/// them.
void sort_in_memory(const Region& region, GaussianParameters& parameters, SplatMemory& memory);

}  // namespace tureen::trainer
