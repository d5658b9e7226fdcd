// The hot loops over the tiles of an image of Gaussians in training, for the vectors of the
// processor, chosen at run time.
#pragma once

#include <cstdint>
#include <span>

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

/// splatting::blend_gaussians() for a tile without opaque surfaces, with its record.
void blend_gaussians_recorded(const splatting::ImageView& view,
                              std::span<const splatting::GaussianEntry> entries,
                              std::span<const std::uint32_t> tile, splatting::TilePixels& pixels,
                              TileRecord& record);

/// Writes the moments of each entry of `tile` to moments[numbers[its index]].
void blend_gaussians_backward(const splatting::ImageView& view,
                              std::span<const splatting::GaussianEntry> entries,
                              std::span<const std::uint32_t> tile,
                              std::span<const std::uint32_t> numbers, const TileRecord& record,
                              const TileGradient& gradient, TileScratch& scratch,
                              std::span<GaussianMoments> moments);

}  // namespace tureen::trainer
