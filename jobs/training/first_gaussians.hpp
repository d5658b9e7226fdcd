// Gaussians that show where the surfaces are, before the first triangle or neural density: a short
// training of splats. It takes a small part of the time of a run, and triangles that begin on its
// surfaces are better than those that begin at random (docs/training.md).
#pragma once

#include <cstdint>
#include <functional>

#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "scene/scene.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/splats/gaussians/gaussian_config.hpp"

namespace tureen {

struct FirstGaussians {
  trainer::GaussianConfig constants;
  /// Photographs are halved until they have at most this many pixels; 0: not at all.
  std::int64_t max_pixels = 0;
  /// The number of steps is lowered to fit this time; 0: not at all.
  double seconds = 0;
};

/// A scene with one layer of Gaussians, at the centre of `region`, the region of interest, in which
/// they begin. The layer may be empty. `progress`: receives the fraction done before each
/// photograph and step; may be empty, and may throw. Without a time, the result has the same bits
/// with any number of threads; `threads`: 0 for all cores.
Scene train_first_gaussians(const Dataset& dataset, const FirstGaussians& first,
                            const Region& region, int threads,
                            const std::function<void(double fraction)>& progress);

// For soups.

/// Whether a run begins with Gaussians: the configuration has them, and the dataset has no points
/// from structure from motion.
bool begins_with_gaussians(const trainer::Config& config, const Dataset& dataset);

/// train_first_gaussians() on small copies of the photographs; they begin in the region, or in the
/// box of the configuration.
Scene first_gaussians(const Dataset& dataset, const trainer::Config& config, Region region,
                      int threads, const std::function<void(double fraction)>& progress);

}  // namespace tureen
