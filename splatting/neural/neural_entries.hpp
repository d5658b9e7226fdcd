// Projected neural densities one by one: their entries for blending, and the tiles that each
// covers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "splatting/ellipse.hpp"
#include "splatting/neural/neural_kernels.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"

namespace tureen::splatting {

/// Reads splat `i`, which is drawn, from the rows of projected_neural_row. x of the outline is NaN
/// if the splat may cover any pixel.
void read_density(const ParameterRows& projected, std::size_t i, NeuralEntry& entry,
                  Ellipse& outline);

/// Adds `splat` to all tiles with a pixel centre in the outline, and to few others.
void list_density(const Ellipse& outline, std::uint32_t splat, TileLists& lists);

}  // namespace tureen::splatting
