// A picture of any size, beyond the window's and the device's, drawn tile by tile with cameras
// whose principal point is shifted and put together row by row.
//
// Tiles begin at whole pixels, so that pixel centres, the 1/256 grid that vertices snap to and the
// samples of supersampling are those of the whole picture; and a multiple of 64 rows and columns
// from its lower left corner, so that the blocks that devices shade pixels in are, too. What
// remains is rounding in float: a vertex may snap to the next 1/256 of a pixel, as its window
// coordinates are rounded elsewhere, or as a large face is clipped at the tile's border.
// The test has the figures.
#pragma once

#include <cstddef>
#include <functional>

#include "runtime/debug_views/inspector.hpp"
#include "runtime/renderer.hpp"

namespace tureen {

/// How pictures are cut and who draws the parts.
struct PictureTiles {
  /// Draws a camera's picture whole; asked for at most `side` rows and columns.
  std::function<Image8(const Camera& camera)> draw = {};
  int side = 4096;  // above 0
  /// No band is larger, but for one that is a single row.
  std::size_t band_bytes = std::size_t(128) << 20;
  /// Called with the fraction done, 0..1, after each tile; may throw to abandon the picture.
  std::function<void(double)> progress = {};
};

/// Takes the whole picture's rows from the top, a band at a time: each is as wide as the picture.
using BandSink = std::function<void(const Image8& rows)>;

/// The part of a camera's picture from `column` and `row` (from the top left corner) on.
Camera cut_out_of(const Camera& camera, glm::ivec2 corner, glm::ivec2 size);

/// Keeps one band and one tile in memory. What `draw`, `sink` and `progress` throw ends it.
void draw_in_bands(const Camera& camera, const PictureTiles& tiles, const BandSink& sink);

/// The picture at once, where memory has room for its 4 bytes a pixel.
Image8 draw_in_tiles(const Camera& camera, const PictureTiles& tiles);

/// Tiles that this renderer or inspector draws; it must outlive them. Throws UsageError where its
/// plan has a resolution scale: tiles that are drawn coarser would not meet.
PictureTiles tiles_of(Renderer& renderer, const gl::Capabilities& capabilities);
PictureTiles tiles_of(Inspector& inspector, const gl::Capabilities& capabilities);

}  // namespace tureen
