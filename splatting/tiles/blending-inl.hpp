// The loop that blends the splats of a tile. Included once for each target of Highway.
#if defined(TUREEN_BLENDING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_BLENDING_INL
#undef TUREEN_BLENDING_INL
#else
#define TUREEN_BLENDING_INL
#endif

#include <algorithm>
#include <cstdint>
#include <span>

#include "splatting/image_view.hpp"
#include "splatting/kernel.hpp"
#include "splatting/layer.hpp"
#include "splatting/tiles/tile_lists.hpp"
#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// Vectors that hold the pixels of a block.
inline constexpr std::size_t parts = std::size_t(block_pixels) / lanes;

/// The centres of the pixels of a tile's block, in image coordinates. (tile_x, tile_y): the tile's
/// upper left pixel.
HWY_INLINE void pixel_centers(int tile_x, int tile_y, int block, Floats (&x)[parts],
                              Floats (&y)[parts]) {
  alignas(64) constexpr float column_of[block_pixels] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                         0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) constexpr float row_of[block_pixels] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                      2, 2, 2, 2, 3, 3, 3, 3};
  const auto column = float(tile_x + block_side * (block % (tile_side / block_side)));
  const auto row = float(tile_y + block_side * (block / (tile_side / block_side)));
  for (std::size_t part = 0; part < parts; ++part) {
    x[part] = hn::Add(hn::Load(d, column_of + part * lanes), constant(column + 0.5f));
    y[part] = hn::Add(hn::Load(d, row_of + part * lanes), constant(row + 0.5f));
  }
}

/// The pixels of a block, in registers. A negative transmittance closes a pixel, as in TilePixels.
struct Block {
  Floats x[parts], y[parts], inverse_behind[parts];  // image coordinates; as TilePixels
  Floats transmittance[parts], red[parts], green[parts], blue[parts];

  HWY_INLINE Block(const TilePixels& pixels, int block) {
    pixel_centers(pixels.x, pixels.y, block, x, y);
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t at = std::size_t(block) * block_pixels + part * lanes;
      transmittance[part] = hn::Load(d, pixels.transmittance + at);
      red[part] = hn::Load(d, pixels.red + at);
      green[part] = hn::Load(d, pixels.green + at);
      blue[part] = hn::Load(d, pixels.blue + at);
      inverse_behind[part] = hn::Load(d, pixels.inverse_behind + at);
    }
  }

  HWY_INLINE void store(TilePixels& pixels, int block) const {
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t at = std::size_t(block) * block_pixels + part * lanes;
      hn::Store(red[part], d, pixels.red + at);
      hn::Store(green[part], d, pixels.green + at);
      hn::Store(blue[part], d, pixels.blue + at);
      hn::Store(transmittance[part], d, pixels.transmittance + at);
    }
  }

  HWY_INLINE bool has_open_pixels() const {
    bool open = false;
    for (std::size_t part = 0; part < parts; ++part)
      open |= !none(hn::Gt(transmittance[part], hn::Zero(d)));
    return open;
  }
};

/// A value for each block of a tile.
using BlockTag = hn::CappedTag<float, blocks_a_tile>;
using Blocks = hn::Vec<BlockTag>;
inline constexpr BlockTag of_blocks;
/// Vectors without lanes have one value.
inline constexpr bool fit_blocks = hn::MaxLanes(of_blocks) == blocks_a_tile;
inline constexpr unsigned all_blocks = (1u << blocks_a_tile) - 1;
/// From the first to the last pixel centre of a block.
inline constexpr float block_extent = block_side - 1;

/// The first pixel centres of a tile's blocks, in image coordinates.
struct BlockCorners {
  Blocks x, y;

  HWY_INLINE explicit BlockCorners(const TilePixels& pixels) {
    alignas(16) constexpr float column_of[blocks_a_tile] = {0, block_side, 0, block_side};
    alignas(16) constexpr float row_of[blocks_a_tile] = {0, 0, block_side, block_side};
    x = hn::Add(hn::Load(of_blocks, column_of), hn::Set(of_blocks, float(pixels.x) + 0.5f));
    y = hn::Add(hn::Load(of_blocks, row_of), hn::Set(of_blocks, float(pixels.y) + 0.5f));
  }
};

/// The largest value of `x_factor` x + `y_factor` y + c in each block, from that at its corner.
HWY_INLINE Blocks largest_in_block(Blocks at_corner, float x_factor, float y_factor) {
  return hn::Add(at_corner, hn::Set(of_blocks, block_extent * (std::max(x_factor, 0.0f) +
                                                               std::max(y_factor, 0.0f))));
}

/// A bit for each lane, at most 16.
template <class Tag>
HWY_INLINE unsigned bits_of(Tag tag, hn::Mask<Tag> mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(tag, mask, bits);
  return bits[0] | unsigned(bits[1]) << 8;
}

/// `color_of` of blend_entries(), for entries of one colour.
struct OneColor {
  template <class Entry>
  HWY_INLINE Vector3 operator()(const Entry& entry, Floats, Floats) const {
    return {constant(entry.red), constant(entry.green), constant(entry.blue)};
  }
};

/// Blends one entry into the open pixels of a block. Returns whether it closes any. `alpha_of` and
/// `color_of` as in blend_entries().
template <class Entry, class AlphaOf, class ColorOf>
HWY_INLINE bool blend_entry(const Entry& entry, const AlphaOf& alpha_of, const ColorOf& color_of,
                            Floats max_alpha, Floats stop, Block& block) {
  bool closes = false;
  for (std::size_t part = 0; part < parts; ++part) {
    Floats& transmittance = block.transmittance[part];
    Floats alpha = hn::Zero(d);
    Mask blended = alpha_of(entry, block.x[part], block.y[part], block.inverse_behind[part], alpha);
    blended = hn::And(blended, hn::Gt(transmittance, hn::Zero(d)));
    if (none(blended)) continue;
    alpha = hn::Min(alpha, max_alpha);
    const Floats behind = hn::NegMulAdd(alpha, transmittance, transmittance);
    const Mask ends = hn::And(blended, hn::Lt(behind, stop));
    blended = hn::AndNot(ends, blended);
    const Floats weight = hn::IfThenElseZero(blended, hn::Mul(alpha, transmittance));
    const Vector3 color = color_of(entry, block.x[part], block.y[part]);
    block.red[part] = hn::MulAdd(weight, color.x, block.red[part]);
    block.green[part] = hn::MulAdd(weight, color.y, block.green[part]);
    block.blue[part] = hn::MulAdd(weight, color.z, block.blue[part]);
    transmittance = hn::IfThenElse(blended, behind, transmittance);
    if (none(ends)) continue;
    transmittance = hn::IfThenElse(ends, hn::Neg(transmittance), transmittance);
    closes = true;
  }
  return closes;
}

/// Blends the entries at these places front to back into the pixels, which may hold earlier splats.
/// `alpha_of(entry, x, y, inverse_behind, alpha)` returns the pixels that the entry covers, and
/// sets their alpha before its largest value is applied. `color_of(entry, x, y)` returns the colour
/// of a covered pixel; elsewhere, a finite one. A splat that would lower a pixel's transmittance
/// below the profile's stop closes the pixel. `alpha_of.blocks(entry, corners)` returns the blocks
/// of the tile, as bits, that the entry may cover.
template <class Entry, class AlphaOf, class ColorOf = OneColor>
HWY_INLINE void blend_entries(const ImageView& view, std::span<const Entry> entries,
                              std::span<const std::uint32_t> tile, const AlphaOf& alpha_of,
                              TilePixels& pixels, const ColorOf& color_of = {}) {
  const Floats max_alpha = constant(view.max_alpha), stop = constant(view.stop_transmittance);
  const BlockCorners corners(pixels);
  constexpr std::size_t splats_a_round = 128;
  std::uint32_t lists[blocks_a_tile][splats_a_round];
  for (unsigned open = all_blocks; !tile.empty() && open != 0;) {
    std::size_t lengths[blocks_a_tile] = {};
    const std::size_t round = std::min(tile.size(), splats_a_round);
    for (std::size_t i = 0; i < round; ++i) {
      const std::uint32_t place = tile[i] & place_mask;
      const unsigned covered = fit_blocks ? alpha_of.blocks(entries[place], corners) : all_blocks;
      for (std::size_t b = 0; b < blocks_a_tile; ++b) {
        lists[b][lengths[b]] = place;
        lengths[b] += covered >> b & 1;
      }
    }
    tile = tile.subspan(round);
    for (std::size_t b = 0; b < blocks_a_tile; ++b) {
      if (lengths[b] == 0 || !(open >> b & 1)) continue;
      Block block(pixels, int(b));
      bool is_open = block.has_open_pixels();
      for (std::size_t i = 0; is_open && i < lengths[b]; ++i)
        if (blend_entry(entries[lists[b][i]], alpha_of, color_of, max_alpha, stop, block))
          is_open = block.has_open_pixels();
      if (!is_open) open &= ~(1u << b);
      block.store(pixels, int(b));
    }
  }
}

/// Adds the entries at these places to `hits`, with `alpha_of` and `color_of` as in
/// blend_entries(). `depth_of(place)` returns a function of (entry, x, y, inverse_behind): the
/// depth along the rays through covered pixels, in layer units.
template <class Entry, class AlphaOf, class DepthOf, class ColorOf = OneColor>
HWY_INLINE void collect_entries(const ImageView& view, std::span<const Entry> entries,
                                std::span<const std::uint32_t> tile, const AlphaOf& alpha_of,
                                const DepthOf& depth_of, const TilePixels& pixels, TileHits& hits,
                                const ColorOf& color_of = {}) {
  const Floats max_alpha = constant(view.max_alpha), scale = constant(hits.scale);
  Floats x[blocks_a_tile][parts], y[blocks_a_tile][parts];
  for (int block = 0; block < blocks_a_tile; ++block)
    pixel_centers(pixels.x, pixels.y, block, x[block], y[block]);
  for (const std::uint32_t splat : tile) {
    const std::uint32_t place = splat & place_mask;
    const Entry& entry = entries[place];
    const auto depth_at = depth_of(place);
    for (std::size_t first = 0; first < tile_pixels; first += lanes) {
      const std::size_t block = first / block_pixels, part = first % block_pixels / lanes;
      const Floats px = x[block][part], py = y[block][part];
      const Floats behind = hn::Load(d, pixels.inverse_behind + first);
      Floats alpha = hn::Zero(d);
      Mask covered = alpha_of(entry, px, py, behind, alpha);
      if (none(covered)) continue;
      const Floats depth = hn::Mul(scale, depth_at(entry, px, py, behind));
      covered = hn::And(covered, hn::Eq(depth, depth));  // not NaN, which has no place in an order
      const Vector3 color = color_of(entry, px, py);
      alignas(64) float is_covered[lanes], depths[lanes], alphas[lanes], red[lanes], green[lanes],
          blue[lanes];
      hn::Store(hn::IfThenElseZero(covered, constant(1.0f)), d, is_covered);
      hn::Store(depth, d, depths);
      hn::Store(hn::Min(alpha, max_alpha), d, alphas);
      hn::Store(color.x, d, red);
      hn::Store(color.y, d, green);
      hn::Store(color.z, d, blue);
      for (std::size_t i = 0; i < lanes; ++i)
        if (is_covered[i] > 0)
          hits.at[first + i].push_back(
              {depths[i], alphas[i], red[i], green[i], blue[i], view.stop_transmittance, place});
    }
  }
}

/// KernelFunctions::blend. `Loops` has the type Entry, the type ColorOf of color_of above, and
/// alpha_of(view), which returns alpha_of.
template <class Loops>
void blend_on(const ImageView& view, std::span<const typename Loops::Entry> entries,
              std::span<const std::uint32_t> tile, TilePixels& pixels) {
  blend_entries(view, entries, tile, Loops::alpha_of(view), pixels, typename Loops::ColorOf{});
}

/// KernelFunctions::collect. `Loops` has depth_of(view, rows, order), too, which returns depth_of.
template <class Loops>
void collect_on(const ImageView& view, const ParameterRows& rows,
                std::span<const std::uint32_t> order,
                std::span<const typename Loops::Entry> entries, std::span<const std::uint32_t> tile,
                const TilePixels& pixels, TileHits& hits) {
  collect_entries(view, entries, tile, Loops::alpha_of(view), Loops::depth_of(view, rows, order),
                  pixels, hits, typename Loops::ColorOf{});
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
