// Projected Gaussians one by one: their entries for blending, and the tiles that each covers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "splatting/gaussian_kernels.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tile_lists.hpp"

namespace tureen::splatting {

/// Half the width and height, in pixels, of the ellipse where alpha is the smallest.
struct GaussianOutline {
  float half_width, half_height;
};

/// Reads splat `i`, which is drawn, from the rows of projected_gaussian_row.
void read_entry(const ParameterRows& projected, std::size_t i, GaussianEntry& entry,
                GaussianOutline& outline);

/// Adds `splat` to all tiles where alpha reaches 2^min_log_alpha at a pixel centre, and to few
/// others.
void list_gaussian(const GaussianEntry& entry, const GaussianOutline& outline, float min_log_alpha,
                   std::uint32_t splat, TileLists& lists);

}  // namespace tureen::splatting
