// The hot loops over the tiles of an image of Gaussians in training, for the vectors of the
// processor, chosen at run time.
#pragma once

#include "splatting/gaussians/gaussian_kernels.hpp"
#include "trainer/splats/tile_passes.hpp"

namespace tureen::trainer {

/// The derivatives of a loss by a splat's colour, and the moments of h = dL/d ln(alpha) over pixels
/// at offsets (x, y) from its centre: sums of h, h x, h y, h x^2, h x y, h y^2. Over the pixels of
/// one tile, or of all. Pixels whose alpha is limited to the profile's largest have h = 0.
struct GaussianMoments {
  float one, x, y, xx, xy, yy, red, green, blue;
  float evident;  // > 0: evident_weight is reached
};

const TileFunctions<splatting::GaussianEntry, GaussianMoments>& gaussian_tile_functions();

}  // namespace tureen::trainer
