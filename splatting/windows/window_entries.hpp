// Projected windows one by one: their entries for blending, and the tiles that each covers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"
#include "splatting/windows/corner_window_kernels.hpp"
#include "splatting/windows/window_kernels.hpp"

namespace tureen::splatting {

/// projected_window_row::outline.
using WindowOutline = std::array<float, 6>;

/// Reads splat `i`, which is drawn, from the rows of projected_window_row.
void read_entry(const ParameterRows& projected, std::size_t i, WindowEntry& entry,
                WindowOutline& outline);
/// The same from rows of projected_corner_row.
void read_corner_entry(const ParameterRows& projected, std::size_t i, CornerWindowEntry& entry,
                       WindowOutline& outline);

/// Adds `splat` to all tiles where rho reaches WindowEntry::min_rho at a pixel centre, and to few
/// others.
void list_window(const WindowOutline& outline, std::uint32_t splat, TileLists& lists);

}  // namespace tureen::splatting
