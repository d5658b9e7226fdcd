// Densification of Gaussians (trainer/splats/splat_densify.hpp): splats whose images move much are
// split along their longest axis.
#pragma once

#include "trainer/splats/gaussians/gaussian_parameters.hpp"
#include "trainer/splats/splat_densify.hpp"

namespace tureen::trainer {

struct DensifyOptions {
  std::size_t max_splats;
  double growth = 0.15;        // DensifyLimits
  float min_opacity = 0.01f;   // below: dead
  float distance = 0.75f;      // of children from their parent's centre, in standard deviations
  float shrink_along = 1.8f;   // divides the children's scale along the longest axis
  float shrink_across = 1.1f;  // and along the others
};

/// densify_splats() with splat_statistic::motion as weight.
DensifyReport densify(const DensifyOptions& options, Random& random, GaussianParameters& parameters,
                      SplatMemory& memory);

}  // namespace tureen::trainer
