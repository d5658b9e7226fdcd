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

/// The pixels of a block, in vectors.
inline constexpr std::size_t parts = std::size_t(block_pixels) / lanes;

/// Blends entries front to back into the pixels, which may hold earlier splats. `alpha_of(entry, x,
/// y, inverse_behind, alpha)` returns the pixels that the entry covers, and their alpha before its
/// largest value is applied. A pixel is closed by a splat that would lower its transmittance below
/// the profile's stop; its transmittance is stored with the sign changed.
template <class Entry, class AlphaOf>
HWY_INLINE void blend_entries(const ImageView& view, std::span<const Entry> entries,
                              std::span<const std::uint32_t> tile, const AlphaOf& alpha_of,
                              TilePixels& pixels) {
  alignas(64) constexpr float column_of[block_pixels] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                         0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) constexpr float row_of[block_pixels] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                      2, 2, 2, 2, 3, 3, 3, 3};
  const Floats max_alpha = constant(view.max_alpha), zero = hn::Zero(d);
  const Floats stop = constant(view.stop_transmittance);
  for (int block = 0; block < blocks_a_tile; ++block) {
    const auto column = float(pixels.x + block_side * (block % (tile_side / block_side)));
    const auto row = float(pixels.y + block_side * (block / (tile_side / block_side)));
    const std::size_t first = std::size_t(block) * block_pixels;
    Floats x[parts], y[parts], transmittance[parts], red[parts], green[parts], blue[parts];
    Floats inverse_behind[parts];
    bool still_open = false;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t at = part * lanes;
      x[part] = hn::Add(hn::Load(d, column_of + at), constant(column + 0.5f));
      y[part] = hn::Add(hn::Load(d, row_of + at), constant(row + 0.5f));
      transmittance[part] = hn::Load(d, pixels.transmittance + first + at);
      red[part] = hn::Load(d, pixels.red + first + at);
      green[part] = hn::Load(d, pixels.green + first + at);
      blue[part] = hn::Load(d, pixels.blue + first + at);
      inverse_behind[part] = hn::Load(d, pixels.inverse_behind + first + at);
      still_open |= !hn::AllFalse(d, hn::Gt(transmittance[part], zero));
    }
    if (!still_open) continue;
    for (const std::uint32_t splat : tile) {
      const Entry& entry = entries[splat & place_mask];
      bool any_open = false, closes = false;
      for (std::size_t part = 0; part < parts; ++part) {
        Floats alpha = zero;
        Mask blended = alpha_of(entry, x[part], y[part], inverse_behind[part], alpha);
        blended = hn::And(blended, hn::Gt(transmittance[part], zero));
        if (hn::AllFalse(d, blended)) continue;
        alpha = hn::Min(alpha, max_alpha);
        const Floats behind = hn::NegMulAdd(alpha, transmittance[part], transmittance[part]);
        const Mask ends = hn::And(blended, hn::Lt(behind, stop));
        blended = hn::AndNot(ends, blended);
        const Floats weight = hn::IfThenElseZero(blended, hn::Mul(alpha, transmittance[part]));
        red[part] = hn::MulAdd(weight, constant(entry.red), red[part]);
        green[part] = hn::MulAdd(weight, constant(entry.green), green[part]);
        blue[part] = hn::MulAdd(weight, constant(entry.blue), blue[part]);
        transmittance[part] = hn::IfThenElse(blended, behind, transmittance[part]);
        if (!hn::AllFalse(d, ends)) {
          transmittance[part] =
              hn::IfThenElse(ends, hn::Neg(transmittance[part]), transmittance[part]);
          closes = true;
        }
      }
      if (!closes) continue;
      for (std::size_t part = 0; part < parts; ++part)
        any_open |= !hn::AllFalse(d, hn::Gt(transmittance[part], zero));
      if (!any_open) break;
    }
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t at = first + part * lanes;
      hn::Store(red[part], d, pixels.red + at);
      hn::Store(green[part], d, pixels.green + at);
      hn::Store(blue[part], d, pixels.blue + at);
      hn::Store(transmittance[part], d, pixels.transmittance + at);
    }
  }
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
