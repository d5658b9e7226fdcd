// The hot loops over the tiles of an image of triangle windows in training, for the vectors of the
// processor, chosen at run time.
#pragma once

#include "splatting/windows/window_kernels.hpp"
#include "trainer/splats/tile_passes.hpp"

namespace tureen::trainer {

/// Sums of h = dL/d ln(alpha) over the pixels of one tile or of all; 0 where alpha is limited to
/// the profile's largest. q_k is h / rho at the pixels whose nearest edge is k. others[0] is the
/// sum of h log2(rho), and others[1] that of the weights if TileGradient::by_square > 0; its part
/// of the derivatives by the colour is in these.
///
/// rho = min_k e_k . (x, y, 1) at the offset (x, y) from WindowEntry's (x, y), and ln(alpha) =
/// ln(opacity) + sigma ln(rho). Where edge k is the nearest, dL/d(e_k) = sigma h / rho (x, y, 1).
using WindowMoments = MomentsOfThree;

/// Smallest rho in h / rho, so that no pixel on an edge outweighs all others (for sigma < 1 the
/// derivative has no bound). A random pixel of a triangle is nearer with a probability of 2e-6.
inline constexpr float min_rho_in_gradient = 1e-6f;

const TileFunctions<splatting::WindowEntry, WindowMoments>& window_tile_functions();

}  // namespace tureen::trainer
