// A function on a face as a sum of lattice levels: the multi-resolution texture of DiffSoup (arXiv
// 2603.27151, section 3).
//
// Levels min .. max are stored one after the other, coarsest first, `channels` floats per texel.
// The value of a face is their sum at the texels of max. Lattices are nested: a texel of level l +
// 1 is a texel of level l or lies in the middle between two.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>

#include "scene/lattice.hpp"

namespace tureen::trainer::levels {

/// Texels of levels min .. max together; 0 where max < min.
constexpr std::size_t texel_count(int min, int max) {
  std::size_t count = 0;
  for (int level = min; level <= max; ++level) count += lattice::texel_count(level);
  return count;
}

/// Sums the levels at the texels of `max` into `fine`, texel_count(max) x channels floats. Sums are
/// rounded to float once per level.
void accumulate(int min, int max, int channels, std::span<const float> all, std::span<float> fine);

/// The inverse: levels with the sum `fine` at every texel of max, to one rounding. Level min has
/// the values at its own texels; each higher level has the residual of the levels below it.
void decompose(int min, int max, int channels, std::span<const float> fine, std::span<float> all);

/// The values of a fine lattice at the texels of a coarser one.
void coarsen(int from, int to, int channels, std::span<const float> fine, std::span<float> coarse);

}  // namespace tureen::trainer::levels
