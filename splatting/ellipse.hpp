// The tiles that an ellipse in the image touches.
#pragma once

#include <cstdint>

#include "splatting/tiles/tile_lists.hpp"

namespace tureen::splatting {

/// The image points at the offsets (dx, dy) from (x, y), in pixels, with
/// (p dx + q dy)^2 + (r dy)^2 <= limit.
struct Ellipse {
  float x, y, p, q, r, limit;
  float half_width, half_height;  // of its box
};

/// Adds `splat` to all tiles with a pixel centre in the ellipse, and to few others.
void list_ellipse(const Ellipse& ellipse, std::uint32_t splat, TileLists& lists);

}  // namespace tureen::splatting
