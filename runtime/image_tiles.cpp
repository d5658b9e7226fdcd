#include "runtime/image_tiles.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/error.hpp"

namespace tureen {

namespace {

/// Pixels a side. GPUs shade 2x2 pixels together, software rasterisers up to 64x64.
constexpr int block = 64;

/// Rounded down to whole blocks if at least one fits.
int in_blocks(int pixels) { return pixels < block ? pixels : pixels / block * block; }

int tile_height(const Camera& camera, const ImageTiles& tiles) {
  const std::size_t row_bytes = std::size_t(camera.width) * sizeof(glm::u8vec4);
  const std::size_t rows = std::max<std::size_t>(tiles.band_bytes / row_bytes, 1);
  return in_blocks(int(std::min<std::size_t>(rows, std::size_t(tiles.side))));
}

void copy_rows(const Image8& tile, int column, Image8& band) {
  for (int y = 0; y < tile.height; ++y)
    std::copy_n(&tile.at(0, y), tile.width, &band.at(column, y));
}

}  // namespace

Camera crop(const Camera& camera, glm::ivec2 corner, glm::ivec2 size) {
  Camera part = camera;
  part.width = size.x;
  part.height = size.y;
  part.cx -= corner.x;
  part.cy -= corner.y;
  return part;
}

void draw_in_bands(const FrameInput& input, const ImageTiles& tiles, const BandSink& sink) {
  const Camera& camera = input.camera;
  assert(camera.width > 0 && camera.height > 0 && tiles.side > 0);
  const int width = in_blocks(tiles.side), height = tile_height(camera, tiles);
  // Bands are aligned with the lower border, as on devices. The uppermost band has the remaining
  // rows.
  for (int row = 0; row < camera.height;) {
    const int rows = (camera.height - row - 1) % height + 1;
    Image8 band(camera.width, rows);
    for (int column = 0; column < camera.width; column += width) {
      const glm::ivec2 size(std::min(width, camera.width - column), rows);
      const Image8 tile = tiles.draw(
          {.camera = crop(camera, {column, row}, size), .time = input.time, .whole = camera});
      assert(tile.width == size.x && tile.height == size.y);
      copy_rows(tile, column, band);
      if (tiles.progress)
        tiles.progress((row + double(rows) * (column + size.x) / camera.width) / camera.height);
    }
    sink(band);
    row += rows;
  }
}

ImageTiles tiles_of(Renderer& renderer, const gl::Capabilities& capabilities) {
  if (renderer.plan().quality.resolution_scale < 1)
    throw UsageError(
        "an image drawn in tiles cannot have a resolution scale: the borders of its tiles would "
        "not match");
  // 2^26 samples: 1 GiB of targets, the limit for images drawn whole.
  constexpr int max_samples = 8192;
  const int largest = std::min(capabilities.max_image_side, max_samples);
  ImageTiles tiles;
  tiles.draw = [&renderer](const FrameInput& input) {
    renderer.draw(input);
    return renderer.read_color();
  };
  tiles.side = std::min(tiles.side, largest / renderer.plan().quality.supersampling);
  return tiles;
}

ImageTiles tiles_at_rest(Renderer& renderer, const gl::Capabilities& capabilities,
                         std::function<void()> between_frames) {
  constexpr int max_pixels = 2048;  // 144 MiB for the sums and the mean
  ImageTiles tiles = tiles_of(renderer, capabilities);
  tiles.draw = [&renderer, between_frames = std::move(between_frames)](const FrameInput& input) {
    for (renderer.draw(input); renderer.can_refine(); renderer.refine()) between_frames();
    return renderer.read_color();
  };
  tiles.side = std::min(tiles.side, max_pixels);
  return tiles;
}

}  // namespace tureen
