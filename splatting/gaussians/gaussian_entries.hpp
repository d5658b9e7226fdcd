// The tiles that a projected Gaussian covers.
#pragma once

#include <cstdint>

#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/tiles/tile_lists.hpp"

namespace tureen::splatting {

/// Adds `splat` to all tiles where alpha reaches 2^min_log_alpha at a pixel centre, and to few
/// others.
void list_gaussian(const GaussianEntry& entry, float min_log_alpha, std::uint32_t splat,
                   TileLists& lists);

}  // namespace tureen::splatting
