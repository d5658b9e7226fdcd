// Lattice textures as files and devices hold them: a byte a channel.
#pragma once

#include "scene/triangle_soup.hpp"

namespace tureen {

/// Float texels rounded to bytes (image/quantise.hpp): no value moves by more than 1/2/255, and the
/// alpha of a texel stays on its side of alpha_threshold. Textures of bytes are left as they are.
void round_to_bytes(LatticeTexture& texture);

}  // namespace tureen
