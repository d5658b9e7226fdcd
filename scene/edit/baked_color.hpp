// Lattice textures without their color MLP. How far that is from the network's colours depends on
// the scene: `tureen tradeoff` measures it.
#pragma once

#include <functional>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// Features 0..2 become the mean of the network's colour over all directions, clamped to [0, 1];
/// the other features become 0. Bytes stay bytes. Texels that no visible point of a face lies next
/// to keep their features 0..2. A texture without a network is returned as it is. `progress` is
/// called now and then with the fraction done, 0..1, and may throw to abandon the work, which takes
/// about two seconds for a million texels on one core.
LatticeTexture baked_color(const LatticeTexture& texture,
                           const std::function<void(double)>& progress = {});

/// Features 0..2 are the colour.
LatticeTexture base_color(LatticeTexture texture);

}  // namespace tureen
