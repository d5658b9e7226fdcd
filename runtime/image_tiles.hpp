// Rendering of an image of any size, beyond the limits of window and device. It is drawn tile by
// tile with shifted principal points and assembled row by row.
//
// Tiles begin at whole pixels, so pixel centres, the 1/256 grid for vertices and the samples of
// supersampling equal those of the whole image. They begin at multiples of 64 rows and columns from
// its lower left corner, so that the devices' blocks of pixels match as well. Rounding in float
// remains: a vertex may snap to the next 1/256 of a pixel, because its window coordinates differ,
// or because a large face is clipped at the tile's border. The test has the figures.
#pragma once

#include <cstddef>
#include <functional>

#include "runtime/renderer.hpp"

namespace tureen {

/// The size of the tiles, and the function that draws them.
struct ImageTiles {
  /// Draws a frame with at most `side` rows and columns.
  std::function<Image8(const FrameInput& input)> draw = {};
  int side = 4096;  // above 0
  /// Largest size of a band in bytes, except for a band of a single row.
  std::size_t band_bytes = std::size_t(128) << 20;
  /// Called with the fraction done, 0..1, after each tile; may throw to cancel.
  std::function<void(double)> progress = {};
};

/// Receives the rows of the image from the top, one band at a time, in full width.
using BandSink = std::function<void(const Image8& rows)>;

/// The camera of the part of an image that begins at `corner` (column and row, from the top left).
Camera crop(const Camera& camera, glm::ivec2 corner, glm::ivec2 size);

/// Holds one band and one tile in memory. Exceptions from `draw`, `sink` and `progress` end it.
void draw_in_bands(const FrameInput& input, const ImageTiles& tiles, const BandSink& sink);

/// Tiles drawn by this renderer, which must outlive them. Throws UsageError if its
/// plan has a resolution scale: tiles drawn at a lower resolution would not match at their borders.
ImageTiles tiles_of(Renderer& renderer, const gl::Capabilities& capabilities);

/// The same for the image at rest (Renderer::draw_at_rest). Its tiles are smaller, because a pixel
/// then needs 36 bytes more. `between_frames` is called before each frame; may throw to cancel.
ImageTiles tiles_at_rest(
    Renderer& renderer, const gl::Capabilities& capabilities,
    std::function<void()> between_frames = [] {});

}  // namespace tureen
