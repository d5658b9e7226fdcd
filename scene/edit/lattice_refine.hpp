// The texture of one face at a finer lattice level: each finer texel takes the interpolated value
// of the coarser lattice. The cells of the finer lattice subdivide those of the coarser one, so the
// piecewise-linear function on the face is unchanged.
#pragma once

#include <span>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// `coarse` holds texel_count(from) texels of `channels` values; `fine` has room for
/// texel_count(to); from <= to. Weights are powers of two, so only the sum is rounded.
void refine_lattice(int from, int to, int channels, std::span<const float> coarse,
                    std::span<float> fine);

/// The highest level of any face; 0 without faces.
int highest_level(const LatticeTexture& texture);

}  // namespace tureen
