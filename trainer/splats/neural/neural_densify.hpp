// Densification of neural densities (trainer/splats/splat_densify.hpp): splats whose images move
// much are split along their longest semi-axis, and their halves have the density of the whole.
#pragma once

#include "trainer/splats/neural/neural_parameters.hpp"
#include "trainer/splats/splat_densify.hpp"

namespace tureen::trainer {

struct NeuralDensifyOptions {
  std::size_t max_splats;
  double growth = 0.3;          // DensifyLimits
  float distance = 0.5f;        // of children from their parent's centre, in its semi-axis
  float shrink_along = 0.6f;    // the children's semi-axis there, over their parent's
  float shrink_across = 0.95f;  // the others
};

/// densify_splats() with splat_statistic::motion as weight.
DensifyReport densify_densities(const NeuralDensifyOptions& options, Random& random,
                                NeuralParameters& parameters, SplatMemory& memory);

/// Moves the centre of splat `i` by `offset` and sets its trained logarithms of semi-axes, with the
/// same density at each point. With the ratio r of the largest semi-axes, new over old, and the old
/// one s: w u + phase stays the same for w' = r w and phase' = phase + w . offset / s; and the
/// optical depth, in units of the largest semi-axis, for amplitudes and an offset times r.
void reshape_density(const glm::vec3& offset, const glm::vec3& log_axes, std::size_t i,
                     NeuralParameters& parameters);

}  // namespace tureen::trainer
