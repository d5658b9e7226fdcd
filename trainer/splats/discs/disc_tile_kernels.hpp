// The hot loops over the tiles of an image of discs in training, for the vectors of the processor,
// chosen at run time.
#pragma once

#include <cstdint>
#include <span>

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

/// splatting::blend_discs() for a tile without opaque surfaces, with its record.
void blend_discs_recorded(const splatting::ImageView& view,
                          std::span<const splatting::DiscEntry> entries,
                          std::span<const std::uint32_t> tile, splatting::TilePixels& pixels,
                          TileRecord& record);

/// Writes the moments of each entry of `tile` to moments[numbers[its index]].
void blend_discs_backward(const splatting::ImageView& view,
                          std::span<const splatting::DiscEntry> entries,
                          std::span<const std::uint32_t> tile,
                          std::span<const std::uint32_t> numbers, const TileRecord& record,
                          const TileGradient& gradient, TileScratch& scratch,
                          std::span<DiscMoments> moments);

}  // namespace tureen::trainer
