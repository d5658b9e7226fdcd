// The hot loops of discs on their planes (2DGS, arXiv 2403.17888; REdiSplats, arXiv 2503.12284),
// for the vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "splatting/image_view.hpp"
#include "splatting/layer.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"

namespace tureen::splatting {

/// Rows of projected discs. A point (u, v) of the disc, in standard deviations, has the homogeneous
/// image point u H_u + v H_v + H_c, in pixels from an origin. If the centre is in front of the near
/// plane, the origin is its image; then H_c = (0, 0, depth).
namespace projected_disc_row {
enum : std::size_t {
  x,
  y,  // the origin
  u_x,
  v_x,
  c_x,
  u_y,
  v_y,
  c_y,
  u_w,
  v_w,
  c_w,
  log_opacity,
  red,
  green,
  blue,   // >= 0
  depth,  // of the centre; NaN: not drawn
  left,
  right,
  top,
  bottom,  // of the box outside of which alpha is below the smallest
  count
};
}

/// A projected disc, as the compositing loop reads it.
struct alignas(64) DiscEntry {
  float x, y, u_x, v_x, c_x, u_y, v_y, c_y, u_w, v_w, c_w, log_opacity, red, green, blue;
};

/// Projects the discs [begin, end), with `begin` a multiple of row_alignment. `discs` has the rows
/// of gaussian_row, `projected` projected_disc_row::count rows of as many splats.
void project_discs(const ImageView& view, const ParameterRows& discs, int harmonics_degree,
                   std::size_t begin, std::size_t end, ParameterRows& projected);

/// Blends the entries front to back into the pixels of a tile.
void blend_discs(const ImageView& view, std::span<const DiscEntry> entries,
                 std::span<const std::uint32_t> tile, TilePixels& pixels);

/// Adds the entries to the hits of a tile (Layer::collect).
void collect_discs(const ImageView& view, std::span<const DiscEntry> entries,
                   std::span<const std::uint32_t> tile, const TilePixels& pixels, TileHits& hits);

}  // namespace tureen::splatting
