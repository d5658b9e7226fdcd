// The loop that blends the splats of a tile. Included once for each target of Highway.
#if defined(TUREEN_BLENDING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_BLENDING_INL
#undef TUREEN_BLENDING_INL
#else
#define TUREEN_BLENDING_INL
#endif

#include <span>

#include "splatting/image_view.hpp"
#include "splatting/layer.hpp"
#include "splatting/tile_lists.hpp"
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
      open |= !hn::AllFalse(d, hn::Gt(transmittance[part], hn::Zero(d)));
    return open;
  }
};

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
    if (hn::AllFalse(d, blended)) continue;
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
    if (hn::AllFalse(d, ends)) continue;
    transmittance = hn::IfThenElse(ends, hn::Neg(transmittance), transmittance);
    closes = true;
  }
  return closes;
}

/// Blends the entries at these places front to back into the pixels, which may hold earlier splats.
/// `alpha_of(entry, x, y, inverse_behind, alpha)` returns the pixels that the entry covers, and
/// sets their alpha before its largest value is applied. `color_of(entry, x, y)` returns the colour
/// of a covered pixel; elsewhere, a finite one. A splat that would lower a pixel's transmittance
/// below the profile's stop closes the pixel.
template <class Entry, class AlphaOf, class ColorOf = OneColor>
HWY_INLINE void blend_entries(const ImageView& view, std::span<const Entry> entries,
                              std::span<const std::uint32_t> tile, const AlphaOf& alpha_of,
                              TilePixels& pixels, const ColorOf& color_of = {}) {
  const Floats max_alpha = constant(view.max_alpha), stop = constant(view.stop_transmittance);
  for (int i = 0; i < blocks_a_tile; ++i) {
    Block block(pixels, i);
    if (!block.has_open_pixels()) continue;
    for (const std::uint32_t splat : tile)
      if (blend_entry(entries[splat & place_mask], alpha_of, color_of, max_alpha, stop, block) &&
          !block.has_open_pixels())
        break;
    block.store(pixels, i);
  }
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
