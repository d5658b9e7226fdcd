// Which splats touch which tile of the image, in the order of blending.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tureen::splatting {

/// Pixels along each side of a tile.
inline constexpr int tile_side = 8;
/// Tiles are blended in blocks, whose pixels fill the widest vectors.
inline constexpr int block_side = 4;
inline constexpr int block_pixels = block_side * block_side;
inline constexpr int tile_pixels = tile_side * tile_side;
inline constexpr int blocks_a_tile = tile_pixels / block_pixels;

/// A tile's pixels: block by block, row by row; within a block likewise.
struct alignas(64) TilePixels {
  float red[tile_pixels], green[tile_pixels], blue[tile_pixels];  // times alpha
  float transmittance[tile_pixels];                               // negative: the pixel is closed
  float inverse_behind[tile_pixels];  // one over the depth of the opaque surface; 0: none
  int x = 0, y = 0;                   // of the upper left pixel
};

/// The range of image coordinates of a row of pixels' centres.
struct Band {
  float low, high;
};

/// A rectangle in image coordinates.
struct Box {
  float left, right, top, bottom;
};

class TileLists {
 public:
  /// Forgets all splats. Later ones are for images of this size, in pixels.
  void begin(int width, int height);

  int columns() const { return columns_; }
  int rows() const { return int(spans_.size()); }

  /// Rows of tiles with pixel centres between these y coordinates: the first, and the one after the
  /// last. NaN: none.
  std::pair<int, int> rows_between(float low, float high) const;
  /// Columns likewise.
  std::pair<int, int> columns_between(float low, float high) const;
  /// The y coordinates of the first and the last pixel centres of a row of tiles.
  static Band band(int row) {
    const auto top = float(row * tile_side);
    return {top + 0.5f, top + float(tile_side) - 0.5f};
  }
  /// Adds a splat to the tiles of a row from column `first` to `last` - 1. Nearer splats must be
  /// added earlier.
  void add_columns(int row, int first, int last, std::uint32_t splat) {
    if (first >= last) return;
    spans_[std::size_t(row)].push_back({splat, pairs_, std::uint16_t(first), std::uint16_t(last)});
    pairs_ += std::uint32_t(last - first);
  }
  /// Adds a splat to the tiles of a row with pixel centres between these x coordinates, in pixels.
  /// NaN: none.
  void add(int row, float low, float high, std::uint32_t splat);

  /// Adds a splat to all tiles with pixel centres in a box.
  void add(const Box& box, std::uint32_t splat);
  /// Adds a splat that may cover any pixel to all tiles.
  void add_everywhere(std::uint32_t splat);

  /// Pairs of a splat and a tile so far. Pairs are numbered as they are added.
  std::uint32_t pairs() const { return pairs_; }

  /// Makes the lists of one row. Rows are independent.
  void finish(int row);
  /// The same, and the lists of pair_numbers(): the numbers of the pairs of splat i plus shifts[i],
  /// modulo 2^32.
  void finish_with_numbers(int row, std::span<const std::uint32_t> shifts);

  /// The splats of a tile, in the order of blending.
  std::span<const std::uint32_t> tile(int column, int row) const {
    const Lists& lists = lists_[std::size_t(row)];
    return {lists.splats.data() + lists.starts[std::size_t(column)],
            lists.splats.data() + lists.starts[std::size_t(column) + 1]};
  }
  /// The shifted numbers of these pairs. Needs finish_with_numbers().
  std::span<const std::uint32_t> pair_numbers(int column, int row) const {
    const Lists& lists = lists_[std::size_t(row)];
    return {lists.numbers.data() + lists.starts[std::size_t(column)],
            lists.numbers.data() + lists.starts[std::size_t(column) + 1]};
  }

 private:
  /// Columns from first to last - 1.
  struct Span {
    std::uint32_t splat;
    std::uint32_t number;  // of the pair with the first column
    std::uint16_t first, last;
  };
  struct Lists {
    std::vector<std::uint32_t> starts;  // of the columns' lists, and the end
    std::vector<std::uint32_t> splats;
    std::vector<std::uint32_t> numbers;  // of the pairs
  };
  template <bool numbered>
  void finish_row(int row, std::span<const std::uint32_t> shifts);

  int columns_ = 0;
  std::uint32_t pairs_ = 0;
  std::vector<std::vector<Span>> spans_;  // for each row
  std::vector<Lists> lists_;              // for each row
};

}  // namespace tureen::splatting
