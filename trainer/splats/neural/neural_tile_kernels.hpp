// The hot loops over the tiles of an image of neural densities in training, for the vectors of the
// processor, chosen at run time.
//
// With the chord's half length h, middle m (from the centre) and optical depth tau, all in the unit
// and the view coordinates of splatting::NeuralEntry, and H = dL/dh and T = dL/dt for the position
// t of the middle on the ray r: the chord of {x : x . Q x <= 1} has h^2 = (1 - m . Q m) / A and
// r . Q m = 0, with A = r . Q r. Then
//   dh = -(m . dQ m) / (2 h A) - h (r . dQ r) / (2 A) + (Q m) . dc / (h A)
//   dt = -(r . dQ m) / A + (Q r) . dc / A
// for changes of Q and of the centre c. In the unit sphere's space, where m is G and r is D, no sum
// cancels for flat ellipsoids.
#pragma once

#include "splatting/neural/neural_kernels.hpp"
#include "trainer/splats/tile_passes.hpp"

namespace tureen::trainer {

/// Places in NeuralMoments.
namespace neural_moment {
enum : std::size_t {
  frequencies,                                    // derivatives by NeuralEntry's, in its order
  phases = frequencies + 3 * splatting::neurons,  // likewise
  amplitudes = phases + splatting::neurons,       // likewise
  offset = amplitudes + splatting::neurons,       // likewise
  /// With p = (H / h G + T D) / A and q = (H h D + T G) / A: G_j p_k + D_j q_k, symmetric, for jk =
  /// xx, yy, zz, yz, xz, xy.
  shape = offset + 1,
  center = shape + 6,   // p
  color = center + 3,   // derivatives by red, green and blue
  evident = color + 3,  // > 0: evident_weight is reached
  used,
  count = 56  // a multiple of 4
};
}

/// Sums over the pixels of one tile, or of all, of a splat. Pixels with no or limited alpha have
/// zeros, but for the colour.
struct alignas(32) NeuralMoments {
  float values[neural_moment::count];
};

const TileFunctions<splatting::NeuralEntry, NeuralMoments>& neural_tile_functions();

}  // namespace tureen::trainer
