// The data between the forward and backward passes of a tile, for splats of any kernel.
//
// The backward pass blends again front to back. With the rendered colour C (background included),
// its derivative g, and the sum S of what is behind the current splat, S = sum_{j > i} w_j c_j . g
// + T_end background . g, a splat of weight w_i = alpha_i T_i has
//
//   dL/dalpha_i = T_i c_i . g - S / (1 - alpha_i)
//
// S begins as C . g and loses w_i c_i . g at each splat: one scalar a pixel. alpha <= max_alpha
// < 1. A derivative q by the sum of squares Q = sum_i w_i c_i . c_i + T_end background . background
// adds q c_i . c_i to each c_i . g here, and q Q to S.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "splatting/image_view.hpp"
#include "splatting/tiles/tile_lists.hpp"

namespace tureen::trainer {

/// A splat that reaches this weight in some pixel is evident: its removal would change the image.
inline constexpr float evident_weight = 0.02f;

/// The splats that the forward pass blended, block by block.
struct TileRecord {
  static constexpr std::uint32_t evident_bit = 1u << 31;
  /// Indices in the tile's list, perhaps with evident_bit. Room for its length times the blocks.
  std::uint32_t* blended = nullptr;
  std::uint32_t ends[splatting::blocks_a_tile] = {};  // of the blocks in `blended`
  bool keeps_squares = false;
  alignas(64) float squares[splatting::tile_pixels];  // Q, without the background; if kept
};

/// The input of a tile's backward pass, in the order of TilePixels.
struct alignas(64) TileGradient {
  float red[splatting::tile_pixels], green[splatting::tile_pixels], blue[splatting::tile_pixels];
  float behind[splatting::tile_pixels];         // S
  float transmittance[splatting::tile_pixels];  // 1, or negative outside the image
  float by_square = 0;                          // q
  int x = 0, y = 0;                             // of the upper left pixel
};

/// Sums over pixels, of a splat with three values q in each pixel. (x, y): the pixel's offset from
/// the entry's (x, y). WindowMoments and DiscMoments define q, h and `others`.
struct alignas(64) MomentsOfThree {
  struct Sums {
    float q[3];
    float color;
  };
  Sums one, x, y;  // of q, q x and q y; of the derivatives by red, by green, and by blue
  float h;
  float others[2];
  float evident;  // > 0: evident_weight is reached
};

/// Sums over a tile's pixels, of one splat.
struct alignas(64) TileLine {
  float values[16];
};

/// Memory of a tile's backward pass, kept between calls.
struct TileScratch {
  std::vector<TileLine> lines;
};

/// The hot loops over a tile, for the vectors of the processor, chosen at run time.
template <class Entry, class Moments>
struct TileFunctions {
  /// splatting::KernelFunctions::blend for a tile without opaque surfaces, with its record.
  void (*blend_recorded)(const splatting::ImageView& view, std::span<const Entry> entries,
                         std::span<const std::uint32_t> tile, splatting::TilePixels& pixels,
                         TileRecord& record);
  /// Writes the moments of each entry of `tile` to moments[numbers[its index]].
  void (*blend_backward)(const splatting::ImageView& view, std::span<const Entry> entries,
                         std::span<const std::uint32_t> tile,
                         std::span<const std::uint32_t> numbers, const TileRecord& record,
                         const TileGradient& gradient, TileScratch& scratch,
                         std::span<Moments> moments);
};

}  // namespace tureen::trainer
