#include "trainer/splats/gaussian_tile_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/gaussian_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/gaussian_alpha-inl.hpp"
#include "trainer/splats/tile_loops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {

using namespace splatting::HWY_NAMESPACE;
using splatting::block_pixels;
using splatting::block_side;
using splatting::blocks_a_tile;
using splatting::GaussianEntry;
using splatting::ImageView;
using splatting::place_mask;
using splatting::tile_side;
using splatting::TilePixels;
using tiles::BlockGradient;

/// Entries that are tested together for the pixels of a block.
constexpr std::size_t tested_batch = 16;

/// The entries of a batch that cover an open pixel of a block.
struct Covering {
  alignas(64) float log_alpha[tested_batch][block_pixels];
  std::uint32_t place[tested_batch];  // in the tile's list
  std::size_t count = 0;
};

/// Without branches: whether an entry covers a block is hard to predict.
HWY_INLINE void find_covering(std::span<const GaussianEntry> entries,
                              std::span<const std::uint32_t> tile, std::size_t begin,
                              Floats min_log_alpha, const Block& block, Covering& covering) {
  Mask open[parts];
  for (std::size_t part = 0; part < parts; ++part)
    open[part] = hn::Gt(block.transmittance[part], hn::Zero(d));
  covering.count = 0;
  const std::size_t end = std::min(begin + tested_batch, tile.size());
  for (std::size_t k = begin; k < end; ++k) {
    const GaussianEntry& entry = entries[tile[k] & place_mask];
    Floats largest = constant(-1e30f);  // of the open pixels
    for (std::size_t part = 0; part < parts; ++part) {
      const Floats log_alpha = log_alpha_of(entry, block.x[part], block.y[part]);
      largest = hn::IfThenElse(open[part], hn::Max(largest, log_alpha), largest);
      hn::Store(log_alpha, d, covering.log_alpha[covering.count] + part * lanes);
    }
    covering.place[covering.count] = std::uint32_t(k);
    covering.count += !hn::AllFalse(d, hn::Ge(largest, min_log_alpha));
  }
}

void blend_recorded_on(const ImageView& view, std::span<const GaussianEntry> entries,
                       std::span<const std::uint32_t> tile, TilePixels& pixels,
                       TileRecord& record) {
  const Floats max_alpha = constant(view.max_alpha), stop = constant(view.stop_transmittance);
  const Floats evident = constant(evident_weight), zero = hn::Zero(d);
  const Floats min_log_alpha = constant(std::log2(view.min_alpha));
  std::uint32_t* end = record.blended;
  for (int i = 0; i < blocks_a_tile; ++i) {
    Block block(pixels, i);
    Covering covering;
    for (std::size_t begin = 0; begin < tile.size() && block.has_open_pixels();
         begin += tested_batch) {
      find_covering(entries, tile, begin, min_log_alpha, block, covering);
      for (std::size_t e = 0; e < covering.count; ++e) {
        const GaussianEntry& entry = entries[tile[covering.place[e]] & place_mask];
        Floats largest = zero;  // weight
        for (std::size_t part = 0; part < parts; ++part) {
          Floats& transmittance = block.transmittance[part];
          const Floats log_alpha = hn::Load(d, covering.log_alpha[e] + part * lanes);
          Mask blended = hn::And(hn::Ge(log_alpha, min_log_alpha), hn::Gt(transmittance, zero));
          const Floats alpha = hn::Min(exp2_of(hn::Max(log_alpha, min_log_alpha)), max_alpha);
          const Floats behind = hn::NegMulAdd(alpha, transmittance, transmittance);
          const Mask ends = hn::And(blended, hn::Lt(behind, stop));
          blended = hn::AndNot(ends, blended);
          const Floats weight = hn::IfThenElseZero(blended, hn::Mul(alpha, transmittance));
          block.red[part] = hn::MulAdd(weight, constant(entry.red), block.red[part]);
          block.green[part] = hn::MulAdd(weight, constant(entry.green), block.green[part]);
          block.blue[part] = hn::MulAdd(weight, constant(entry.blue), block.blue[part]);
          transmittance = hn::IfThenElse(blended, behind, transmittance);
          transmittance = hn::IfThenElse(ends, hn::Neg(transmittance), transmittance);
          largest = hn::Max(largest, weight);
        }
        // An entry that only closes pixels is recorded, too: the backward pass repeats this.
        *end++ = covering.place[e] |
                 (hn::AllFalse(d, hn::Ge(largest, evident)) ? 0u : TileRecord::evident_bit);
      }
    }
    block.store(pixels, i);
    record.ends[i] = std::uint32_t(end - record.blended);
  }
}

/// Sums over the pixels of a block are products with a matrix. Pixel p has the pair (h, weight),
/// stored together; row p of the matrix is
///   1, g.red, x, g.green, y, g.blue, x^2, 0, x y, 0, y^2, 0
/// with x and y from the middle of the tile. One broadcast of a pair serves all columns.
constexpr std::size_t columns = 12;
constexpr std::size_t column_parts = (columns + lanes - 1) / lanes;
constexpr std::size_t row_floats = 16;
/// The column of TileLine whose products are 0; it holds GaussianMoments::evident.
constexpr std::size_t evident_column = 7;
/// Entries whose sums are in registers at the same time.
constexpr std::size_t batch = lanes == 16 ? 8 : 4;

// Highway's target without vectors has no pairs of lanes.
#define TUREEN_HAS_VECTORS (HWY_TARGET != HWY_SCALAR)

/// The pixel of the pair at a place of the buffer, as store_pairs() orders them.
constexpr std::size_t pixel_of(std::size_t pair) {
  if constexpr (lanes == 1) return pair;
  constexpr std::size_t half_lanes = lanes > 1 ? lanes / 2 : 1;
  const std::size_t part = pair / lanes, in_part = pair % lanes;
  const std::size_t half = in_part / half_lanes, in_half = in_part % half_lanes;
  return part * lanes + 4 * (in_half / 2) + 2 * half + in_half % 2;
}

HWY_INLINE void store_pairs(Floats h, Floats weight, float* pairs) {
#if TUREEN_HAS_VECTORS
  hn::Store(hn::InterleaveLower(d, h, weight), d, pairs);
  hn::Store(hn::InterleaveUpper(d, h, weight), d, pairs + lanes);
#else
  hn::Store(h, d, pairs);
  hn::Store(weight, d, pairs + 1);
#endif
}

/// The pair in all lanes of even and odd index.
HWY_INLINE Floats broadcast_pair(const float* pair, [[maybe_unused]] std::size_t part) {
#if TUREEN_HAS_VECTORS
  const hn::Repartition<std::uint64_t, FloatTag> du64;
  std::uint64_t both;
  std::memcpy(&both, pair, sizeof both);
  return hn::BitCast(d, hn::Set(du64, both));
#else
  return constant(pair[part % 2]);
#endif
}

struct alignas(64) Buffers {
  float pairs[batch][2 * block_pixels];
  float matrix[block_pixels][row_floats];
};

HWY_INLINE void write_matrix(const TileGradient& gradient, int block, Buffers& buffers) {
  constexpr int blocks_a_side = tile_side / block_side;
  const auto left = float(block_side * (block % blocks_a_side)) - 0.5f * float(tile_side - 1);
  const auto top = float(block_side * (block / blocks_a_side)) - 0.5f * float(tile_side - 1);
  for (std::size_t pair = 0; pair < block_pixels; ++pair) {
    const std::size_t pixel = pixel_of(pair), at = std::size_t(block) * block_pixels + pixel;
    const float x = left + float(pixel % block_side), y = top + float(pixel / block_side);
    const float row[row_floats] = {
        1, gradient.red[at], x, gradient.green[at], y, gradient.blue[at], x * x, 0, x * y, 0, y * y,
        0};
    std::memcpy(buffers.matrix[pair], row, sizeof row);
  }
}

/// Adds the sums of the entries in the buffers to their lines.
HWY_INLINE void add_sums(const Buffers& buffers, const std::uint32_t (&of)[batch],
                         std::size_t count, TileLine* lines) {
  Floats sums[batch][column_parts];
  for (std::size_t e = 0; e < batch; ++e)
    for (std::size_t part = 0; part < column_parts; ++part) sums[e][part] = hn::Zero(d);
  for (std::size_t pair = 0; pair < block_pixels; ++pair) {
    Floats row[column_parts];
    for (std::size_t part = 0; part < column_parts; ++part)
      row[part] = hn::Load(d, buffers.matrix[pair] + part * lanes);
    for (std::size_t e = 0; e < batch; ++e) {
      for (std::size_t part = 0; part < column_parts; ++part)
        sums[e][part] =
            hn::MulAdd(broadcast_pair(buffers.pairs[e] + 2 * pair, part), row[part], sums[e][part]);
    }
  }
  for (std::size_t e = 0; e < count; ++e) {
    float* line = lines[of[e]].values;
    for (std::size_t part = 0; part < column_parts; ++part)
      hn::Store(hn::Add(hn::Load(d, line + part * lanes), sums[e][part]), d, line + part * lanes);
  }
}

/// Blends an entry again, and writes (h, weight) of the block's pixels.
HWY_INLINE void replay(const ImageView& view, const GaussianEntry& entry, Floats min_log_alpha,
                       BlockGradient& block, float* pairs) {
  for (std::size_t part = 0; part < parts; ++part) {
    const Floats log_alpha = log_alpha_of(entry, block.x[part], block.y[part]);
    const Mask covered = hn::Ge(log_alpha, min_log_alpha);
    const Floats unlimited = exp2_of(hn::Max(log_alpha, min_log_alpha));
    const Floats alpha = hn::Min(unlimited, constant(view.max_alpha));
    const Floats ratio = hn::Div(alpha, hn::Sub(constant(1.0f), alpha));
    const auto [weight, h] =
        tiles::blend_again(view, entry, covered, unlimited, ratio, block, part);
    store_pairs(h, weight, pairs + 2 * part * lanes);
  }
}

/// Moves the origin of moments from the middle of a tile to the splat's centre, `x` and `y` pixels
/// before it.
HWY_INLINE GaussianMoments moved(const float* line, float x, float y) {
  GaussianMoments m;
  m.one = line[0];
  m.x = line[2] + x * m.one;
  m.y = line[4] + y * m.one;
  m.xx = line[6] + x * (line[2] + m.x);
  m.xy = line[8] + x * line[4] + y * m.x;
  m.yy = line[10] + y * (line[4] + m.y);
  m.red = line[1];
  m.green = line[3];
  m.blue = line[5];
  m.evident = line[evident_column];
  return m;
}

void blend_backward_on(const ImageView& view, std::span<const GaussianEntry> entries,
                       std::span<const std::uint32_t> tile, std::span<const std::uint32_t> numbers,
                       const TileRecord& record, TileGradient& gradient, TileScratch& scratch,
                       std::span<GaussianMoments> moments) {
  const Floats min_log_alpha = constant(std::log2(view.min_alpha));
  if (scratch.lines.size() < tile.size()) scratch.lines.resize(tile.size());
  TileLine* lines = scratch.lines.data();
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
        // Without a branch, which would be hard to predict.
        float& is_evident = lines[of[e]].values[evident_column];
        is_evident = std::max(is_evident, blended & TileRecord::evident_bit ? 1.0f : 0.0f);
        replay(view, entries[tile[of[e]] & place_mask], min_log_alpha, block, buffers.pairs[e]);
      }
      add_sums(buffers, of, count, lines);
    }
  }
  const float middle_x = float(gradient.x) + 0.5f * tile_side;
  const float middle_y = float(gradient.y) + 0.5f * tile_side;
  for (std::size_t k = 0; k < tile.size(); ++k) {
    const GaussianEntry& entry = entries[tile[k] & place_mask];
    moments[numbers[k]] = moved(lines[k].values, middle_x - entry.x, middle_y - entry.y);
  }
}

}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(blend_recorded_on);
HWY_EXPORT(blend_backward_on);

void blend_gaussians_recorded(const splatting::ImageView& view,
                              std::span<const splatting::GaussianEntry> entries,
                              std::span<const std::uint32_t> tile, splatting::TilePixels& pixels,
                              TileRecord& record) {
  HWY_DYNAMIC_DISPATCH(blend_recorded_on)(view, entries, tile, pixels, record);
}

void blend_gaussians_backward(const splatting::ImageView& view,
                              std::span<const splatting::GaussianEntry> entries,
                              std::span<const std::uint32_t> tile,
                              std::span<const std::uint32_t> numbers, const TileRecord& record,
                              TileGradient& gradient, TileScratch& scratch,
                              std::span<GaussianMoments> moments) {
  HWY_DYNAMIC_DISPATCH(blend_backward_on)
  (view, entries, tile, numbers, record, gradient, scratch, moments);
}

}  // namespace tureen::trainer
#endif
