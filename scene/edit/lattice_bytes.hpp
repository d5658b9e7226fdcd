// Lattice textures in the representation of files and devices: one byte a channel.
#pragma once

#include "scene/triangle_soup.hpp"

namespace tureen {

/// Rounds float texels to bytes (image/quantise.hpp). The error is at most 1/2/255, and the alpha
/// of a texel stays on its side of alpha_threshold. Byte textures are unchanged.
void round_to_bytes(LatticeTexture& texture);

}  // namespace tureen
