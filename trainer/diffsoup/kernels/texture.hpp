// The levels of a face's texture: parents of texels, and offsets.
//
// The lattice of level L+1 contains the lattice of level L. Each of its texels is a coarser texel
// or lies in the middle between two. The sum over levels is therefore a pyramid: refine, add,
// refine, add.
#pragma once

#include "scene/lattice.hpp"
#include "trainer/common/kernels/host_device.hpp"
#include "trainer/common/kernels/scalar.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer::kernels {

/// Texel (x, y) of level + 1 is the mean of these two texels of `level`. Both are the same if it
/// coincides with one.
struct Parents {
  std::uint32_t a, b;
};

TUREEN_HOST_DEVICE Parents parents(int x, int y) {
  // An odd coordinate lies between two columns or rows. If both are odd, the texel lies on the
  // diagonal that divides the coarser cell.
  const int x_odd = x & 1, y_odd = y & 1, half_x = x >> 1, half_y = y >> 1;
  if (x_odd && y_odd)
    return {lattice::texel_index(half_x + 1, half_y), lattice::texel_index(half_x, half_y + 1)};
  return {lattice::texel_index(half_x, half_y),
          lattice::texel_index(half_x + x_odd, half_y + y_odd)};
}

/// Number of texels in levels low .. high - 1: the offset of level `high`.
TUREEN_HOST_DEVICE std::uint32_t level_begin(int low, int high) {
  std::uint32_t sum = 0;
  for (int level = low; level < high; ++level) sum += lattice::texel_count(level);
  return sum;
}

}  // namespace tureen::trainer::kernels
