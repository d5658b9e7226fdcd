// The loops over the splats of a tile in training that windows and discs share. Included once for
// each target of Highway.
#if defined(TUREEN_TILE_LOOPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_TILE_LOOPS_INL
#undef TUREEN_TILE_LOOPS_INL
#else
#define TUREEN_TILE_LOOPS_INL
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstring>

#include "splatting/blending-inl.hpp"
#include "trainer/splats/tile_passes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace tiles {

using namespace splatting::HWY_NAMESPACE;
using splatting::block_pixels;
using splatting::block_side;
using splatting::blocks_a_tile;
using splatting::ImageView;
using splatting::place_mask;
using splatting::tile_side;
using splatting::TilePixels;

template <class Entry>
HWY_INLINE float square_of_color(const Entry& entry) {
  return entry.red * entry.red + entry.green * entry.green + entry.blue * entry.blue;
}

/// blend_entries() for a tile without opaque surfaces, with its record.
template <class Entry, class AlphaOf>
HWY_INLINE void blend_recorded(const ImageView& view, std::span<const Entry> entries,
                               std::span<const std::uint32_t> tile, const AlphaOf& alpha_of,
                               TilePixels& pixels, TileRecord& record) {
  const Floats max_alpha = constant(view.max_alpha), stop = constant(view.stop_transmittance);
  const Floats evident = constant(evident_weight);
  std::uint32_t* end = record.blended;
  // Entries are far apart in memory: each would be a cache miss.
  for (const std::uint32_t splat : tile) hwy::Prefetch(&entries[splat & place_mask]);
  for (int i = 0; i < blocks_a_tile; ++i) {
    Block block(pixels, i);
    Floats squares[parts];
    std::fill_n(squares, parts, hn::Zero(d));
    if (block.has_open_pixels()) {
      for (std::uint32_t k = 0; k < tile.size(); ++k) {
        // An entry that only closes pixels is recorded, too: the backward pass repeats this.
        bool changes = false;
        std::uint32_t bit = 0;
        const Entry& entry = entries[tile[k] & place_mask];
        const auto seen = [&](std::size_t part, Floats weight) {
          changes = true;
          if (!hn::AllFalse(d, hn::Ge(weight, evident))) bit = TileRecord::evident_bit;
          if (record.keeps_squares)
            squares[part] = hn::MulAdd(weight, constant(square_of_color(entry)), squares[part]);
        };
        const bool closes = blend_entry(entry, alpha_of, max_alpha, stop, block, seen);
        *end = k | bit;
        end += changes;
        if (closes && !block.has_open_pixels()) break;
      }
      block.store(pixels, i);
    }
    if (record.keeps_squares)
      for (std::size_t part = 0; part < parts; ++part)
        hn::Store(squares[part], d, record.squares + std::size_t(i) * block_pixels + part * lanes);
    record.ends[i] = std::uint32_t(end - record.blended);
  }
}

/// Sums over the pixels of a block are products with a matrix. Pixel p has four values, stored
/// together: three of the kernel, and the weight. Row p of the matrix is
///   1, 1, 1, g.red, x, x, x, g.green, y, y, y, g.blue
/// with x and y from the middle of the tile. One broadcast of the four values serves all columns.
/// Four more columns hold sums that have no factor; the last one is that of the evident weight.
constexpr std::size_t columns = 12;
constexpr std::size_t column_parts = (columns + lanes - 1) / lanes;
constexpr std::size_t row_floats = 16;
constexpr std::size_t h_column = 12, evident_column = 15;
/// Entries whose sums are in registers at the same time.
constexpr std::size_t batch = lanes == 16 ? 8 : 4;

/// The four values in all lanes, as the columns of this part need them.
HWY_INLINE Floats broadcast_four(const float* four, [[maybe_unused]] std::size_t part) {
#if HWY_TARGET == HWY_SCALAR
  return constant(four[part % 4]);
#else
  return hn::LoadDup128(d, four);
#endif
}

struct alignas(64) Buffers {
  float fours[batch][4 * block_pixels];
  float matrix[block_pixels][row_floats];
};

HWY_INLINE void write_matrix(const TileGradient& gradient, int block, Buffers& buffers) {
  constexpr int blocks_a_side = tile_side / block_side;
  const auto left = float(block_side * (block % blocks_a_side)) - 0.5f * float(tile_side - 1);
  const auto top = float(block_side * (block / blocks_a_side)) - 0.5f * float(tile_side - 1);
  for (std::size_t pixel = 0; pixel < block_pixels; ++pixel) {
    const std::size_t at = std::size_t(block) * block_pixels + pixel;
    const float x = left + float(pixel % block_side), y = top + float(pixel / block_side);
    const float row[row_floats] = {1, 1, 1, gradient.red[at],  x, x, x, gradient.green[at],
                                   y, y, y, gradient.blue[at], 0, 0, 0, 0};
    std::memcpy(buffers.matrix[pixel], row, sizeof row);
  }
}

/// Adds the sums of the entries in the buffers to their lines.
HWY_INLINE void add_sums(const Buffers& buffers, const std::uint32_t (&of)[batch],
                         std::size_t count, TileLine* lines) {
  Floats sums[batch][column_parts];
  for (std::size_t e = 0; e < batch; ++e)
    for (std::size_t part = 0; part < column_parts; ++part) sums[e][part] = hn::Zero(d);
  for (std::size_t pixel = 0; pixel < block_pixels; ++pixel) {
    Floats row[column_parts];
    for (std::size_t part = 0; part < column_parts; ++part)
      row[part] = hn::Load(d, buffers.matrix[pixel] + part * lanes);
    for (std::size_t e = 0; e < batch; ++e)
      for (std::size_t part = 0; part < column_parts; ++part)
        sums[e][part] = hn::MulAdd(broadcast_four(buffers.fours[e] + 4 * pixel, part), row[part],
                                   sums[e][part]);
  }
  for (std::size_t e = 0; e < count; ++e) {
    float* line = lines[of[e]].values;
    for (std::size_t part = 0; part < column_parts; ++part)
      hn::Store(hn::Add(hn::Load(d, line + part * lanes), sums[e][part]), d, line + part * lanes);
  }
}

/// The pixels of a block that the backward pass blends again.
struct BlockGradient {
  Floats x[parts], y[parts], red[parts], green[parts], blue[parts], behind[parts],
      transmittance[parts];
  float by_square;

  HWY_INLINE BlockGradient(const TileGradient& tile, int block) : by_square(tile.by_square) {
    pixel_centers(tile.x, tile.y, block, x, y);
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t at = std::size_t(block) * block_pixels + part * lanes;
      red[part] = hn::Load(d, tile.red + at);
      green[part] = hn::Load(d, tile.green + at);
      blue[part] = hn::Load(d, tile.blue + at);
      behind[part] = hn::Load(d, tile.behind + at);
      transmittance[part] = hn::Load(d, tile.transmittance + at);
    }
  }
};

/// The derivatives of a vector of a block's pixels.
struct Replayed {
  Floats weight;
  Floats h;  // dL/d ln(alpha); 0 where alpha is limited to the largest
};

/// Blends an entry again into the pixels that it covers. `unlimited` is alpha before it is limited
/// to the largest, `ratio` is alpha / (1 - alpha) after.
template <class Entry>
HWY_INLINE Replayed blend_again(const ImageView& view, const Entry& entry, Mask covered,
                                Floats unlimited, Floats ratio, BlockGradient& block,
                                std::size_t part) {
  Floats& transmittance = block.transmittance[part];
  Floats& behind = block.behind[part];
  const Floats max_alpha = constant(view.max_alpha);
  const Floats alpha = hn::Min(unlimited, max_alpha);
  const Floats after = hn::NegMulAdd(alpha, transmittance, transmittance);
  Mask blended = hn::And(covered, hn::Gt(transmittance, hn::Zero(d)));
  const Mask ends = hn::And(blended, hn::Lt(after, constant(view.stop_transmittance)));
  blended = hn::AndNot(ends, blended);
  Replayed result;
  result.weight = hn::IfThenElseZero(blended, hn::Mul(alpha, transmittance));
  const Floats along =
      hn::MulAdd(constant(entry.red), block.red[part],
                 hn::MulAdd(constant(entry.green), block.green[part],
                            hn::MulAdd(constant(entry.blue), block.blue[part],
                                       constant(block.by_square * square_of_color(entry)))));
  behind = hn::NegMulAdd(result.weight, along, behind);
  const Mask moves = hn::And(blended, hn::Le(unlimited, max_alpha));
  result.h = hn::IfThenElseZero(moves, hn::NegMulAdd(behind, ratio, hn::Mul(result.weight, along)));
  transmittance = hn::IfThenElse(blended, after, transmittance);
  transmittance = hn::IfThenElse(ends, hn::Neg(transmittance), transmittance);
  return result;
}

/// Blends the recorded splats of a tile again. `replay(entry, block, fours, line)` writes the four
/// values of the block's pixels, and adds the sums that have no factor to the line.
/// `moved(entry, line, x, y)` makes the moments of a line about the entry's (x, y) from those about
/// the middle of the tile, `x` and `y` pixels after it.
template <class Entry, class Moments, class Replay, class Moved>
HWY_INLINE void blend_backward(std::span<const Entry> entries, std::span<const std::uint32_t> tile,
                               std::span<const std::uint32_t> numbers, const TileRecord& record,
                               TileGradient& gradient, TileScratch& scratch,
                               std::span<Moments> moments, const Replay& replay,
                               const Moved& moved) {
  if (scratch.lines.size() < tile.size()) scratch.lines.resize(tile.size());
  TileLine* lines = scratch.lines.data();
  for (const std::uint32_t splat : tile) hwy::Prefetch(&entries[splat & place_mask]);
  std::memset(lines, 0, tile.size() * sizeof *lines);
  Buffers buffers{};
  for (int i = 0; i < blocks_a_tile; ++i) {
    const std::uint32_t begin = i == 0 ? 0 : record.ends[i - 1], end = record.ends[i];
    if (begin == end) continue;
    write_matrix(gradient, i, buffers);
    BlockGradient block(gradient, i);
    for (std::uint32_t first = begin; first < end; first += batch) {
      const std::size_t count = std::min<std::size_t>(batch, end - first);
      std::uint32_t of[batch] = {};
      for (std::size_t e = 0; e < count; ++e) {
        const std::uint32_t blended = record.blended[first + e];
        of[e] = blended & ~TileRecord::evident_bit;
        float* line = lines[of[e]].values;
        if (blended & TileRecord::evident_bit) line[evident_column] = 1;
        replay(entries[tile[of[e]] & place_mask], block, buffers.fours[e], line);
      }
      add_sums(buffers, of, count, lines);
    }
  }
  const float middle_x = float(gradient.x) + 0.5f * tile_side;
  const float middle_y = float(gradient.y) + 0.5f * tile_side;
  for (std::size_t k = 0; k < tile.size(); ++k) {
    const Entry& entry = entries[tile[k] & place_mask];
    moments[numbers[k]] = moved(entry, lines[k].values, middle_x - entry.x, middle_y - entry.y);
  }
}

}  // namespace tiles
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
