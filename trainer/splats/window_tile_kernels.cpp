#include "trainer/splats/window_tile_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/window_tile_kernels.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/blending-inl.hpp"
#include "splatting/window_alpha-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace windows {

using namespace splatting::HWY_NAMESPACE;
using splatting::block_pixels;
using splatting::block_side;
using splatting::blocks_a_tile;
using splatting::ImageView;
using splatting::place_mask;
using splatting::tile_side;
using splatting::TilePixels;
using splatting::WindowEntry;

/// The pixels that a window covers: where alpha reaches the smallest value, behind the near plane.
HWY_INLINE Mask covers(const WindowEntry& entry, const WindowAt& at, Floats inverse_near) {
  const Mask covered = hn::Ge(at.rho, constant(entry.min_rho));
  if (!entry.reaches_near) return covered;
  const Floats inverse_depth = at.linear(entry.inverse_depth);
  return hn::And(covered,
                 hn::And(hn::Gt(inverse_depth, hn::Zero(d)), hn::Lt(inverse_depth, inverse_near)));
}

/// WindowAlpha without opaque surfaces.
struct AlphaAlone {
  Floats inverse_near;

  HWY_INLINE Mask operator()(const WindowEntry& entry, Floats x, Floats y, Floats,
                             Floats& alpha) const {
    const WindowAt at(entry, x, y);
    const Mask covered = covers(entry, at, inverse_near);
    if (hn::AllFalse(d, covered)) return covered;
    alpha = window_alpha_of(entry, log_rho_of(at.rho));
    return covered;
  }
};

void blend_windows_recorded_on(const ImageView& view, std::span<const WindowEntry> entries,
                               std::span<const std::uint32_t> tile, TilePixels& pixels,
                               TileRecord& record) {
  const Floats max_alpha = constant(view.max_alpha), stop = constant(view.stop_transmittance);
  const Floats evident = constant(evident_weight);
  const AlphaAlone alpha_of{constant(1.0f / view.near)};
  std::uint32_t* end = record.blended;
  // Entries are far apart in memory: each would be a cache miss.
  for (const std::uint32_t splat : tile) hwy::Prefetch(&entries[splat & place_mask]);
  for (int i = 0; i < blocks_a_tile; ++i) {
    Block block(pixels, i);
    if (block.has_open_pixels()) {
      for (std::uint32_t k = 0; k < tile.size(); ++k) {
        // An entry that only closes pixels is recorded, too: the backward pass repeats this.
        bool changes = false;
        std::uint32_t bit = 0;
        const bool closes = blend_entry(entries[tile[k] & place_mask], alpha_of, max_alpha, stop,
                                        block, [&](Floats weight) {
                                          changes = true;
                                          if (!hn::AllFalse(d, hn::Ge(weight, evident)))
                                            bit = TileRecord::evident_bit;
                                        });
        *end = k | bit;
        end += changes;
        if (closes && !block.has_open_pixels()) break;
      }
      block.store(pixels, i);
    }
    record.ends[i] = std::uint32_t(end - record.blended);
  }
}

/// Sums over the pixels of a block are products with a matrix. Pixel p has four values, stored
/// together: h / rho where edge 0, 1 or 2 is the nearest, and the weight. Row p of the matrix is
///   1, 1, 1, g.red, x, x, x, g.green, y, y, y, g.blue
/// with x and y from the middle of the tile. One broadcast of the four values serves all columns.
/// Three more columns hold sums that have no factor.
constexpr std::size_t columns = 12;
constexpr std::size_t column_parts = (columns + lanes - 1) / lanes;
constexpr std::size_t row_floats = 16;
constexpr std::size_t h_column = 12, log_column = 13, evident_column = 14;
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
                         std::size_t count, WindowScratch::Line* lines) {
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

  HWY_INLINE BlockGradient(const TileGradient& tile, int block) {
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

/// Blends an entry again, writes the four values of the block's pixels, and adds the sums that have
/// no factor to its line.
HWY_INLINE void replay(const ImageView& view, const WindowEntry& entry, BlockGradient& block,
                       float* fours, float* line) {
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  const Floats max_alpha = constant(view.max_alpha), stop = constant(view.stop_transmittance);
  const Floats inverse_near = constant(1.0f / view.near);
  Floats h_sum = zero, log_sum = zero;
  for (std::size_t part = 0; part < parts; ++part) {
    Floats& transmittance = block.transmittance[part];
    Floats& behind = block.behind[part];
    const WindowAt at(entry, block.x[part], block.y[part]);
    Mask blended = hn::And(covers(entry, at, inverse_near), hn::Gt(transmittance, zero));
    const Floats log_rho = log_rho_of(at.rho);
    const Floats unlimited = window_alpha_of(entry, log_rho);
    const Floats alpha = hn::Min(unlimited, max_alpha);
    const Floats after = hn::NegMulAdd(alpha, transmittance, transmittance);
    const Mask ends = hn::And(blended, hn::Lt(after, stop));
    blended = hn::AndNot(ends, blended);
    const Floats weight = hn::IfThenElseZero(blended, hn::Mul(alpha, transmittance));
    const Floats along = hn::MulAdd(constant(entry.red), block.red[part],
                                    hn::MulAdd(constant(entry.green), block.green[part],
                                               hn::Mul(constant(entry.blue), block.blue[part])));
    behind = hn::NegMulAdd(weight, along, behind);
    // One division for alpha / (1 - alpha) and 1 / rho.
    const Floats rho = hn::Max(at.rho, constant(min_rho_in_gradient));
    const Floats left = hn::Sub(one, alpha);
    const Floats inverse = hn::Div(one, hn::Mul(left, rho));
    const Floats ratio = hn::Mul(alpha, hn::Mul(inverse, rho));
    const Mask moves = hn::And(blended, hn::Le(unlimited, max_alpha));
    const Floats h =
        hn::IfThenElseZero(moves, hn::NegMulAdd(behind, ratio, hn::Mul(weight, along)));
    h_sum = hn::Add(h_sum, h);
    log_sum = hn::MulAdd(h, log_rho, log_sum);
    // rho is at most 1: beyond, no edge moves alpha.
    const Floats by_rho =
        hn::IfThenElseZero(hn::Le(at.rho, one), hn::Mul(h, hn::Mul(inverse, left)));
    const Mask nearest_0 = hn::Eq(at.rho, at.distance[0]);
    const Mask nearest_1 = hn::AndNot(nearest_0, hn::Eq(at.rho, at.distance[1]));
    const Floats of_0 = hn::IfThenElseZero(nearest_0, by_rho);
    const Floats of_1 = hn::IfThenElseZero(nearest_1, by_rho);
    const Floats of_2 = hn::IfThenZeroElse(hn::Or(nearest_0, nearest_1), by_rho);
    hn::StoreInterleaved4(of_0, of_1, of_2, weight, d, fours + 4 * part * lanes);
    transmittance = hn::IfThenElse(blended, after, transmittance);
    transmittance = hn::IfThenElse(ends, hn::Neg(transmittance), transmittance);
  }
  line[h_column] += hn::GetLane(hn::SumOfLanes(d, h_sum));
  line[log_column] += hn::GetLane(hn::SumOfLanes(d, log_sum));
}

/// Moves the origin of moments from the middle of a tile to the entry's (x, y), `x` and `y` pixels
/// before it.
HWY_INLINE WindowMoments moved(const float* line, float x, float y) {
  WindowMoments m;
  for (std::size_t k = 0; k < 3; ++k)
    m.edges[k] = {line[k], line[4 + k] + x * line[k], line[8 + k] + y * line[k]};
  m.h = line[h_column];
  m.h_log_rho = line[log_column];
  m.red = line[3];
  m.green = line[7];
  m.blue = line[11];
  m.evident = line[evident_column];
  m.unused = 0;
  return m;
}

void blend_windows_backward_on(const ImageView& view, std::span<const WindowEntry> entries,
                               std::span<const std::uint32_t> tile,
                               std::span<const std::uint32_t> numbers, const TileRecord& record,
                               TileGradient& gradient, WindowScratch& scratch,
                               std::span<WindowMoments> moments) {
  if (scratch.lines.size() < tile.size()) scratch.lines.resize(tile.size());
  WindowScratch::Line* lines = scratch.lines.data();
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
        replay(view, entries[tile[of[e]] & place_mask], block, buffers.fours[e], line);
      }
      add_sums(buffers, of, count, lines);
    }
  }
  const float middle_x = float(gradient.x) + 0.5f * tile_side;
  const float middle_y = float(gradient.y) + 0.5f * tile_side;
  for (std::size_t k = 0; k < tile.size(); ++k) {
    const WindowEntry& entry = entries[tile[k] & place_mask];
    moments[numbers[k]] = moved(lines[k].values, middle_x - entry.x, middle_y - entry.y);
  }
}

}  // namespace windows
using windows::blend_windows_backward_on;
using windows::blend_windows_recorded_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(blend_windows_recorded_on);
HWY_EXPORT(blend_windows_backward_on);

void blend_windows_recorded(const splatting::ImageView& view,
                            std::span<const splatting::WindowEntry> entries,
                            std::span<const std::uint32_t> tile, splatting::TilePixels& pixels,
                            TileRecord& record) {
  HWY_DYNAMIC_DISPATCH(blend_windows_recorded_on)(view, entries, tile, pixels, record);
}

void blend_windows_backward(const splatting::ImageView& view,
                            std::span<const splatting::WindowEntry> entries,
                            std::span<const std::uint32_t> tile,
                            std::span<const std::uint32_t> numbers, const TileRecord& record,
                            TileGradient& gradient, WindowScratch& scratch,
                            std::span<WindowMoments> moments) {
  HWY_DYNAMIC_DISPATCH(blend_windows_backward_on)
  (view, entries, tile, numbers, record, gradient, scratch, moments);
}

}  // namespace tureen::trainer
#endif
