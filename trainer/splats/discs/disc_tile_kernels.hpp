// The hot loops over the tiles of an image of discs in training, for the vectors of the processor,
// chosen at run time.
#pragma once

#include "splatting/discs/disc_kernels.hpp"
#include "trainer/splats/tile_passes.hpp"

namespace tureen::trainer {

/// Sums of h = dL/d ln(alpha) over the pixels of one tile or of all; 0 where alpha is limited to
/// the profile's largest.
///
/// A ray meets the disc's plane at (u, v) = (p_u, p_v) / p_w, p = k x l, where k and l are the
/// lines of splatting::DiscAt, and ln(alpha) = ln(opacity) - (u^2 + v^2) / 2. So q = dL/dp = -h /
/// p_w (u, v, -u^2 - v^2) at the pixels whose alpha is that on the plane. At the others, alpha is
/// that of the filter on the screen: `others` are the sums of h x and h y there.
using DiscMoments = MomentsOfThree;

const TileFunctions<splatting::DiscEntry, DiscMoments>& disc_tile_functions();

}  // namespace tureen::trainer
