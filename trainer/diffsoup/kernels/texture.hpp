// The texture of one face: levels summed, a sigmoid, and interpolation; and the way back.
//
// A lattice of level L+1 contains that of level L: each of its texels either is one of the coarser
// ones or lies half way between two. So the sum over levels is a pyramid: refine, add, refine, add.
#pragma once

#include "scene/lattice.hpp"
#include "trainer/common/kernels/host_device.hpp"
#include "trainer/common/kernels/scalar.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer::kernels {

/// The two texels of `level` that texel (x, y) of level + 1 is the mean of; twice the same one
/// where it is one of them.
struct Parents {
  std::uint32_t a, b;
};

TUREEN_HOST_DEVICE Parents parents(int x, int y) {
  // An odd coordinate lies between two columns or rows; where both are odd, the mean is along the
  // diagonal that divides the coarser cell.
  const int x_odd = x & 1, y_odd = y & 1, half_x = x >> 1, half_y = y >> 1;
  if (x_odd && y_odd)
    return {lattice::texel_index(half_x + 1, half_y), lattice::texel_index(half_x, half_y + 1)};
  return {lattice::texel_index(half_x, half_y),
          lattice::texel_index(half_x + x_odd, half_y + y_odd)};
}

/// Texels of the levels low .. high - 1 together: where level `high` begins.
TUREEN_HOST_DEVICE std::uint32_t level_begin(int low, int high) {
  std::uint32_t sum = 0;
  for (int level = low; level < high; ++level) sum += lattice::texel_count(level);
  return sum;
}

}  // namespace tureen::trainer::kernels
