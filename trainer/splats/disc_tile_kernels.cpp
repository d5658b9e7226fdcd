#include "trainer/splats/disc_tile_kernels.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/disc_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/disc_alpha-inl.hpp"
#include "trainer/splats/tile_loops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace discs {

using namespace tiles;
using splatting::DiscEntry;

/// DiscAlpha without opaque surfaces.
struct AlphaAlone {
  Floats min_log_alpha;
  DiscConstants constants;

  HWY_INLINE Mask operator()(const DiscEntry& entry, Floats x, Floats y, Floats,
                             Floats& alpha) const {
    const Floats log_alpha = DiscAt(entry, constants, x, y).log_alpha(entry);
    const Mask covered = hn::Ge(log_alpha, min_log_alpha);
    if (hn::AllFalse(d, covered)) return covered;
    alpha = exp2_of(hn::Max(log_alpha, min_log_alpha));
    return covered;
  }
};

void blend_discs_recorded_on(const ImageView& view, std::span<const DiscEntry> entries,
                             std::span<const std::uint32_t> tile, TilePixels& pixels,
                             TileRecord& record) {
  blend_recorded(view, entries, tile,
                 AlphaAlone{constant(std::log2(view.min_alpha)), disc_constants(view)}, pixels,
                 record);
}

constexpr std::size_t screen_column = h_column + 1;

/// Blends an entry again, writes the four values of the block's pixels, and adds the sums that have
/// no factor to its line.
HWY_INLINE void replay(const ImageView& view, const DiscConstants& constants,
                       const DiscEntry& entry, BlockGradient& block, float* fours, float* line) {
  const Floats min_log_alpha = constant(std::log2(view.min_alpha));
  Floats h_sum = hn::Zero(d), screen_x = hn::Zero(d), screen_y = hn::Zero(d);
  for (std::size_t part = 0; part < parts; ++part) {
    const DiscAt at(entry, constants, block.x[part], block.y[part]);
    const Floats log_alpha = at.log_alpha(entry);
    const Mask covered = hn::Ge(log_alpha, min_log_alpha);
    const Floats unlimited = exp2_of(hn::Max(log_alpha, min_log_alpha));
    const Floats alpha = hn::Min(unlimited, constant(view.max_alpha));
    const Floats ratio = hn::Div(alpha, hn::Sub(constant(1.0f), alpha));
    const auto [weight, h] = blend_again(view, entry, covered, unlimited, ratio, block, part);
    h_sum = hn::Add(h_sum, h);
    const Floats filtered = hn::IfThenElseZero(at.filtered, h);
    screen_x = hn::MulAdd(filtered, at.dx, screen_x);
    screen_y = hn::MulAdd(filtered, at.dy, screen_y);
    // Where h is 0, the other factors may be infinite.
    const Mask on_plane = hn::AndNot(at.filtered, hn::Ne(h, hn::Zero(d)));
    const Floats scale = hn::IfThenElseZero(on_plane, hn::Mul(h, at.by_point));
    const auto times = [&](Floats value) {
      return hn::IfThenElseZero(on_plane, hn::Mul(scale, value));
    };
    hn::StoreInterleaved4(times(hn::Neg(at.u)), times(hn::Neg(at.v)), times(at.squared), weight, d,
                          fours + 4 * part * lanes);
  }
  const auto add = [&](std::size_t column, Floats sum) {
    line[column] += hn::GetLane(hn::SumOfLanes(d, sum));
  };
  add(h_column, h_sum);
  add(screen_column, screen_x);
  add(screen_column + 1, screen_y);
}

/// Moves the origin of moments from the middle of a tile to the entry's (x, y), `x` and `y` pixels
/// before it.
HWY_INLINE DiscMoments moved(const DiscEntry&, const float* line, float x, float y) {
  const auto about = [&](const float* sums, float offset) -> DiscMoments::Sum {
    return {sums[0] + offset * line[0], sums[1] + offset * line[1], sums[2] + offset * line[2]};
  };
  return {.one = {line[0], line[1], line[2]},
          .x = about(line + 4, x),
          .y = about(line + 8, y),
          .screen_x = line[screen_column],
          .screen_y = line[screen_column + 1],
          .h = line[h_column],
          .red = line[3],
          .green = line[7],
          .blue = line[11],
          .evident = line[evident_column]};
}

void blend_discs_backward_on(const ImageView& view, std::span<const DiscEntry> entries,
                             std::span<const std::uint32_t> tile,
                             std::span<const std::uint32_t> numbers, const TileRecord& record,
                             TileGradient& gradient, TileScratch& scratch,
                             std::span<DiscMoments> moments) {
  const DiscConstants constants = disc_constants(view);
  blend_backward(
      entries, tile, numbers, record, gradient, scratch, moments,
      [&](const DiscEntry& entry, BlockGradient& block, float* fours, float* line) {
        replay(view, constants, entry, block, fours, line);
      },
      moved);
}

}  // namespace discs
using discs::blend_discs_backward_on;
using discs::blend_discs_recorded_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(blend_discs_recorded_on);
HWY_EXPORT(blend_discs_backward_on);

void blend_discs_recorded(const splatting::ImageView& view,
                          std::span<const splatting::DiscEntry> entries,
                          std::span<const std::uint32_t> tile, splatting::TilePixels& pixels,
                          TileRecord& record) {
  HWY_DYNAMIC_DISPATCH(blend_discs_recorded_on)(view, entries, tile, pixels, record);
}

void blend_discs_backward(const splatting::ImageView& view,
                          std::span<const splatting::DiscEntry> entries,
                          std::span<const std::uint32_t> tile,
                          std::span<const std::uint32_t> numbers, const TileRecord& record,
                          TileGradient& gradient, TileScratch& scratch,
                          std::span<DiscMoments> moments) {
  HWY_DYNAMIC_DISPATCH(blend_discs_backward_on)
  (view, entries, tile, numbers, record, gradient, scratch, moments);
}

}  // namespace tureen::trainer
#endif
