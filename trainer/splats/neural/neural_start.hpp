// The first neural densities.
#pragma once

#include "scene/splats.hpp"
#include "trainer/common/random.hpp"
#include "trainer/splats/neural/neural_parameters.hpp"

namespace tureen::trainer {

/// The largest offset of a first density: alpha reaches its limit of 0.99 along a third of the
/// largest semi-axis, and beyond, its derivative is 0.
inline constexpr float max_first_offset = 8;

/// The offset of a first density with this opacity along `chord`, in units of the largest
/// semi-axis; at most max_first_offset.
float offset_for(float opacity, float chord);

/// Sets the network of splat `i`, as a SIREN begins (arXiv 2006.09661; the authors' code): uniform
/// weights and phases from -1/3 to 1/3, times omega, and amplitudes from -1 to 1 times sqrt(6 / 8)
/// / omega.
void set_first_network(float offset, Random& random, std::size_t i, NeuralParameters& parameters);

/// Densities at the places of Gaussians with three scales, and with their colours. Semi-axes are
/// two standard deviations.
NeuralParameters densities_from(const Splats& gaussians, int degree, Random& random);

}  // namespace tureen::trainer
