// The loops over the splats of a tile in training, for any kernel. Included once for each target of
// Highway.
//
// A kernel is a struct with constants of the view, `view` itself, made from it and from
// TileGradient::by_square, and
//   Entry, Moments
//   value_of(entry, x, y)     a value at pixels, below the threshold where the entry is not drawn;
//                             or instead find_covering(), as below with an end and the open pixels
//   threshold_of(entry)       the entry covers the pixels whose value is at least this
//   alpha_of(entry, value)    alpha before it is limited to the largest; anything below the
//                             threshold, where it is not used
//   values_a_pixel            2 or 4: the layout of PixelValues; for its sums see `columns`
//   replay(entry, block, values, sums)    blends the entry again (blend_again()), and writes the
//                             values of the block's pixels, and up to three sums without a factor
//   sums_squares              whether TileRecord::keeps_squares is supported
//   moved(entry, line, x, y)  the moments about the entry's (x, y) from those about the middle of
//                             the tile, `x` and `y` pixels after it.
#if defined(TUREEN_TILE_LOOPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_TILE_LOOPS_INL
#undef TUREEN_TILE_LOOPS_INL
#else
#define TUREEN_TILE_LOOPS_INL
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstring>

#include "splatting/tiles/blending-inl.hpp"
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

/// Entries that are tested together for the pixels of a block.
constexpr std::size_t tested_batch = 16;

/// The entries of a batch that cover an open pixel of a block.
struct Covering {
  alignas(64) float values[tested_batch][block_pixels];
  std::uint32_t place[tested_batch];  // in the tile's list
  std::size_t count = 0;
};

/// Without branches: whether an entry covers a block is hard to predict.
template <class Kernel>
HWY_INLINE void find_covering(const Kernel& kernel, std::span<const typename Kernel::Entry> entries,
                              std::span<const std::uint32_t> tile, std::size_t begin,
                              const Block& block, Covering& covering) {
  Mask open[parts];
  for (std::size_t part = 0; part < parts; ++part)
    open[part] = hn::Gt(block.transmittance[part], hn::Zero(d));
  const Mask none = hn::Lt(hn::Zero(d), hn::Zero(d));
  covering.count = 0;
  const std::size_t end = std::min(begin + tested_batch, tile.size());
  if constexpr (requires { &Kernel::find_covering; })
    return kernel.find_covering(entries, tile, begin, end, block, open, covering);
  else
    for (std::size_t k = begin; k < end; ++k) {
      const auto& entry = entries[tile[k] & place_mask];
      const Floats threshold = kernel.threshold_of(entry);
      Mask covered = none;
      for (std::size_t part = 0; part < parts; ++part) {
        const Floats value = kernel.value_of(entry, block.x[part], block.y[part]);
        covered = hn::Or(covered, hn::And(open[part], hn::Ge(value, threshold)));
        hn::Store(value, d, covering.values[covering.count] + part * lanes);
      }
      covering.place[covering.count] = std::uint32_t(k);
      covering.count += !hn::AllFalse(d, covered);
    }
}

/// Blends the entries front to back into a tile without opaque surfaces, with its record.
/// `squares`: as TileRecord::keeps_squares.
template <bool squares, class Kernel>
HWY_INLINE void blend_recorded(const Kernel& kernel, const ImageView& view,
                               std::span<const typename Kernel::Entry> entries,
                               std::span<const std::uint32_t> tile, TilePixels& pixels,
                               TileRecord& record) {
  const Floats max_alpha = constant(view.max_alpha), stop = constant(view.stop_transmittance);
  const Floats evident = constant(evident_weight), zero = hn::Zero(d);
  std::uint32_t* end = record.blended;
  for (int i = 0; i < blocks_a_tile; ++i) {
    Block block(pixels, i);
    Floats square[parts];
    std::fill_n(square, parts, zero);
    Covering covering;
    for (std::size_t begin = 0; begin < tile.size() && block.has_open_pixels();
         begin += tested_batch) {
      find_covering(kernel, entries, tile, begin, block, covering);
      for (std::size_t e = 0; e < covering.count; ++e) {
        const auto& entry = entries[tile[covering.place[e]] & place_mask];
        const Floats threshold = kernel.threshold_of(entry);
        Floats largest = zero;  // weight
        for (std::size_t part = 0; part < parts; ++part) {
          Floats& transmittance = block.transmittance[part];
          const Floats value = hn::Load(d, covering.values[e] + part * lanes);
          Mask blended = hn::And(hn::Ge(value, threshold), hn::Gt(transmittance, zero));
          const Floats alpha = hn::Min(kernel.alpha_of(entry, value), max_alpha);
          const Floats behind = hn::NegMulAdd(alpha, transmittance, transmittance);
          const Mask ends = hn::And(blended, hn::Lt(behind, stop));
          blended = hn::AndNot(ends, blended);
          const Floats weight = hn::IfThenElseZero(blended, hn::Mul(alpha, transmittance));
          block.red[part] = hn::MulAdd(weight, constant(entry.red), block.red[part]);
          block.green[part] = hn::MulAdd(weight, constant(entry.green), block.green[part]);
          block.blue[part] = hn::MulAdd(weight, constant(entry.blue), block.blue[part]);
          if constexpr (squares)
            square[part] = hn::MulAdd(weight, constant(square_of_color(entry)), square[part]);
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
    if constexpr (squares)
      for (std::size_t part = 0; part < parts; ++part)
        hn::Store(square[part], d, record.squares + std::size_t(i) * block_pixels + part * lanes);
    record.ends[i] = std::uint32_t(end - record.blended);
  }
}

/// Sums over the pixels of a block are products with a matrix. The backward pass stores the values
/// of a pixel together, and one broadcast of them serves all columns of the pixel's row.
///
/// Two values: the kernel's one, and the weight. The row is
///   1, g.red, x, g.green, y, g.blue, x^2, 0, x y, 0, y^2, 0
/// Four values: three of the kernel, and the weight. The row is
///   1, 1, 1, g.red, x, x, x, g.green, y, y, y, g.blue
/// with x and y from the middle of the tile. Four more columns hold sums that have no factor: three
/// of the kernel, and the number of blocks with the evident weight.
constexpr std::size_t columns = 12;
constexpr std::size_t column_parts = (columns + lanes - 1) / lanes;
constexpr std::size_t row_floats = 16;
constexpr std::size_t factorless = 4, evident_column = 15;
/// Entries whose sums are in registers at the same time.
constexpr std::size_t batch = lanes == 16 ? 8 : 4;

// Highway's target without vectors has no groups of lanes.
#define TUREEN_HAS_VECTORS (HWY_TARGET != HWY_SCALAR)

template <std::size_t values_a_pixel>
struct PixelValues;

template <>
struct PixelValues<2> {
  static HWY_INLINE void write_row(float x, float y, float red, float green, float blue,
                                   float* row) {
    const float values[columns] = {1, red, x, green, y, blue, x * x, 0, x * y, 0, y * y, 0};
    std::memcpy(row, values, sizeof values);
  }

  /// The pixel whose values store() puts at this place.
  static constexpr std::size_t pixel_of(std::size_t place) {
    if constexpr (lanes == 1) return place;
    constexpr std::size_t half_lanes = lanes > 1 ? lanes / 2 : 1;
    const std::size_t part = place / lanes, in_part = place % lanes;
    const std::size_t half = in_part / half_lanes, in_half = in_part % half_lanes;
    return part * lanes + 4 * (in_half / 2) + 2 * half + in_half % 2;
  }

  static HWY_INLINE void store(Floats first, Floats weight, float* values) {
#if TUREEN_HAS_VECTORS
    hn::Store(hn::InterleaveLower(d, first, weight), d, values);
    hn::Store(hn::InterleaveUpper(d, first, weight), d, values + lanes);
#else
    hn::Store(first, d, values);
    hn::Store(weight, d, values + 1);
#endif
  }

  /// The values of a pixel in all lanes, as the columns of this part need them.
  static HWY_INLINE Floats broadcast(const float* values, [[maybe_unused]] std::size_t part) {
#if TUREEN_HAS_VECTORS
    const hn::Repartition<std::uint64_t, FloatTag> du64;
    std::uint64_t both;
    std::memcpy(&both, values, sizeof both);
    return hn::BitCast(d, hn::Set(du64, both));
#else
    return constant(values[part % 2]);
#endif
  }
};

template <>
struct PixelValues<4> {
  static HWY_INLINE void write_row(float x, float y, float red, float green, float blue,
                                   float* row) {
    const float values[columns] = {1, 1, 1, red, x, x, x, green, y, y, y, blue};
    std::memcpy(row, values, sizeof values);
  }

  static constexpr std::size_t pixel_of(std::size_t place) { return place; }

  static HWY_INLINE void store(Floats first, Floats second, Floats third, Floats weight,
                               float* values) {
    hn::StoreInterleaved4(first, second, third, weight, d, values);
  }

  static HWY_INLINE MomentsOfThree moved(const float* line, float x, float y) {
    MomentsOfThree m;
    const auto move = [&](const float* of, float by) -> MomentsOfThree::Sums {
      return {{of[0] + by * line[0], of[1] + by * line[1], of[2] + by * line[2]}, of[3]};
    };
    m.one = move(line, 0);
    m.x = move(line + 4, x);
    m.y = move(line + 8, y);
    m.h = line[columns];
    m.others[0] = line[columns + 1];
    m.others[1] = line[columns + 2];
    m.evident = line[evident_column];
    return m;
  }

  static HWY_INLINE Floats broadcast(const float* values, [[maybe_unused]] std::size_t part) {
#if TUREEN_HAS_VECTORS
    return hn::LoadDup128(d, values);
#else
    return constant(values[part % 4]);
#endif
  }
};

template <std::size_t values_a_pixel>
struct alignas(64) Buffers {
  float values[batch][values_a_pixel * block_pixels];
  float sums[batch][factorless];
  float matrix[block_pixels][row_floats];
};

template <std::size_t values_a_pixel>
HWY_INLINE void write_matrix(const TileGradient& gradient, int block,
                             Buffers<values_a_pixel>& buffers) {
  using Values = PixelValues<values_a_pixel>;
  constexpr int blocks_a_side = tile_side / block_side;
  const auto left = float(block_side * (block % blocks_a_side)) - 0.5f * float(tile_side - 1);
  const auto top = float(block_side * (block / blocks_a_side)) - 0.5f * float(tile_side - 1);
  for (std::size_t place = 0; place < block_pixels; ++place) {
    const std::size_t pixel = Values::pixel_of(place);
    const std::size_t at = std::size_t(block) * block_pixels + pixel;
    Values::write_row(left + float(pixel % block_side), top + float(pixel / block_side),
                      gradient.red[at], gradient.green[at], gradient.blue[at],
                      buffers.matrix[place]);
  }
}

/// Adds the sums of the entries in the buffers to their lines.
template <std::size_t values_a_pixel>
HWY_INLINE void add_sums(const Buffers<values_a_pixel>& buffers, const std::uint32_t (&of)[batch],
                         std::size_t count, TileLine* lines) {
  Floats sums[batch][column_parts];
  for (std::size_t e = 0; e < batch; ++e)
    for (std::size_t part = 0; part < column_parts; ++part) sums[e][part] = hn::Zero(d);
  for (std::size_t place = 0; place < block_pixels; ++place) {
    Floats row[column_parts];
    for (std::size_t part = 0; part < column_parts; ++part)
      row[part] = hn::Load(d, buffers.matrix[place] + part * lanes);
    for (std::size_t e = 0; e < batch; ++e) {
      const float* values = buffers.values[e] + values_a_pixel * place;
      for (std::size_t part = 0; part < column_parts; ++part)
        sums[e][part] = hn::MulAdd(PixelValues<values_a_pixel>::broadcast(values, part), row[part],
                                   sums[e][part]);
    }
  }
  for (std::size_t e = 0; e < count; ++e) {
    float* line = lines[of[e]].values;
    for (std::size_t part = 0; part < column_parts; ++part)
      hn::Store(hn::Add(hn::Load(d, line + part * lanes), sums[e][part]), d, line + part * lanes);
    // After the vectors, not in replay(): a vector load right after scalar stores to its memory
    // waits for them.
    for (std::size_t k = 0; k < factorless; ++k) line[columns + k] += buffers.sums[e][k];
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

/// An entry blended again into a vector of a block's pixels.
struct Again {
  Floats weight;
  Floats along;  // c . g, see trainer/splats/tile_passes.hpp
  Floats after;  // the transmittance behind the entry, where it is blended
  Mask moves;    // it is blended, and alpha is not limited to the largest
};

/// Blends an entry again into the pixels that it covers. `unlimited` is alpha before it is limited
/// to the largest.
template <class Entry>
HWY_INLINE Again again(const ImageView& view, const Entry& entry, Mask covered, Floats unlimited,
                       BlockGradient& block, std::size_t part) {
  Floats& transmittance = block.transmittance[part];
  Floats& behind = block.behind[part];
  const Floats max_alpha = constant(view.max_alpha);
  const Floats alpha = hn::Min(unlimited, max_alpha);
  Again result;
  result.after = hn::NegMulAdd(alpha, transmittance, transmittance);
  Mask blended = hn::And(covered, hn::Gt(transmittance, hn::Zero(d)));
  const Mask ends = hn::And(blended, hn::Lt(result.after, constant(view.stop_transmittance)));
  blended = hn::AndNot(ends, blended);
  result.weight = hn::IfThenElseZero(blended, hn::Mul(alpha, transmittance));
  result.along =
      hn::MulAdd(constant(entry.red), block.red[part],
                 hn::MulAdd(constant(entry.green), block.green[part],
                            hn::MulAdd(constant(entry.blue), block.blue[part],
                                       constant(block.by_square * square_of_color(entry)))));
  behind = hn::NegMulAdd(result.weight, result.along, behind);
  result.moves = hn::And(blended, hn::Le(unlimited, max_alpha));
  transmittance = hn::IfThenElse(blended, result.after, transmittance);
  transmittance = hn::IfThenElse(ends, hn::Neg(transmittance), transmittance);
  return result;
}

/// The derivatives of a vector of a block's pixels.
struct Replayed {
  Floats weight;
  Floats h;  // dL/d ln(alpha); 0 where alpha is limited to the largest
};

/// The same with its derivatives. `ratio` is alpha / (1 - alpha) after it is limited.
template <class Entry>
HWY_INLINE Replayed blend_again(const ImageView& view, const Entry& entry, Mask covered,
                                Floats unlimited, Floats ratio, BlockGradient& block,
                                std::size_t part) {
  const Again a = again(view, entry, covered, unlimited, block, part);
  return {a.weight, hn::IfThenElseZero(a.moves, hn::NegMulAdd(block.behind[part], ratio,
                                                              hn::Mul(a.weight, a.along)))};
}

/// The same for an entry with this value at the pixels.
template <class Kernel>
HWY_INLINE Replayed blend_again(const Kernel& kernel, const typename Kernel::Entry& entry,
                                Floats value, BlockGradient& block, std::size_t part) {
  const Mask covered = hn::Ge(value, kernel.threshold_of(entry));
  const Floats unlimited = kernel.alpha_of(entry, value);
  const Floats alpha = hn::Min(unlimited, constant(kernel.view.max_alpha));
  const Floats ratio = hn::Div(alpha, hn::Sub(constant(1.0f), alpha));
  return blend_again(kernel.view, entry, covered, unlimited, ratio, block, part);
}

/// TileFunctions::blend_recorded.
template <class Kernel>
void blend_tile_recorded(const ImageView& view, std::span<const typename Kernel::Entry> entries,
                         std::span<const std::uint32_t> tile, TilePixels& pixels,
                         TileRecord& record) {
  const Kernel kernel(view, 0);
  if constexpr (Kernel::sums_squares)
    if (record.keeps_squares)
      return blend_recorded<true>(kernel, view, entries, tile, pixels, record);
  blend_recorded<false>(kernel, view, entries, tile, pixels, record);
}

/// TileFunctions::blend_backward: blends the recorded splats again.
template <class Kernel>
void blend_tile_backward(const ImageView& view, std::span<const typename Kernel::Entry> entries,
                         std::span<const std::uint32_t> tile,
                         std::span<const std::uint32_t> numbers, const TileRecord& record,
                         const TileGradient& gradient, TileScratch& scratch,
                         std::span<typename Kernel::Moments> moments) {
  const Kernel kernel(view, gradient.by_square);
  if (scratch.lines.size() < tile.size()) scratch.lines.resize(tile.size());
  TileLine* lines = scratch.lines.data();
  std::memset(lines, 0, tile.size() * sizeof *lines);
  Buffers<Kernel::values_a_pixel> buffers{};
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
        buffers.sums[e][evident_column - columns] = blended & TileRecord::evident_bit ? 1.0f : 0.0f;
        kernel.replay(entries[tile[of[e]] & place_mask], block, buffers.values[e], buffers.sums[e]);
      }
      add_sums(buffers, of, count, lines);
    }
  }
  const float middle_x = float(gradient.x) + 0.5f * tile_side;
  const float middle_y = float(gradient.y) + 0.5f * tile_side;
  for (std::size_t k = 0; k < tile.size(); ++k) {
    const auto& entry = entries[tile[k] & place_mask];
    moments[numbers[k]] =
        kernel.moved(entry, lines[k].values, middle_x - entry.x, middle_y - entry.y);
  }
}

template <class Kernel>
constexpr TileFunctions<typename Kernel::Entry, typename Kernel::Moments> tile_functions{
    &blend_tile_recorded<Kernel>, &blend_tile_backward<Kernel>};

}  // namespace tiles
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
