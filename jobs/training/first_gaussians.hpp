// Gaussians that show where the surfaces are, before the first triangle: a short training of splats
// on small copies of the photographs. It takes a small part of the time of a run, and triangles
// that begin on its surfaces are better than those that begin at random (docs/training.md).
#pragma once

#include <functional>

#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "scene/scene.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen {

/// Whether a run begins with Gaussians: the configuration has them, and the dataset has no points
/// from structure from motion.
bool begins_with_gaussians(const trainer::Config& config, const Dataset& dataset);

/// A scene with one layer of Gaussians, at the centre of `region`, the region of interest; they
/// begin in it, or in the box of the configuration. The layer may be empty. `progress`: receives
/// the fraction done before each photograph and step; may be empty, and may throw. The result has
/// the same bits with any number of threads; `threads`: 0 for all cores.
Scene first_gaussians(const Dataset& dataset, const trainer::Config& config, Region region,
                      int threads, const std::function<void(double fraction)>& progress);

}  // namespace tureen
