// Lattice textures without their color MLP. The error against the network's colours depends on the
// scene; `tureen tradeoff` measures it.
#pragma once

#include <functional>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// Features 0..2 become the mean of the network's colour over all directions, clamped to [0, 1];
/// the other features become 0. Bytes stay bytes. A texel without adjacent visible points keeps its
/// features 0..2. A texture without a network is returned unchanged. `progress` is called with the
/// fraction done, 0..1; it may throw to cancel. Time: about 2 s per million texels on one core.
LatticeTexture baked_color(const LatticeTexture& texture,
                           const std::function<void(double)>& progress = {});

/// Features 0..2 are the colour.
LatticeTexture base_color(LatticeTexture texture);

}  // namespace tureen
