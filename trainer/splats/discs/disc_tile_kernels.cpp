#include "trainer/splats/discs/disc_tile_kernels.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/discs/disc_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/discs/disc_alpha-inl.hpp"
#include "trainer/splats/tile_loops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace discs {

using namespace tiles;
using splatting::DiscEntry;

/// The kernel of the loops. A value is log2(alpha).
struct Discs {
  using Entry = DiscEntry;
  using Moments = DiscMoments;
  static constexpr std::size_t values_a_pixel = 4;
  static constexpr bool sums_squares = false;
  const ImageView& view;
  DiscConstants constants;
  Floats min_log_alpha;

  Discs(const ImageView& image, float)
      : view(image),
        constants(disc_constants(image)),
        min_log_alpha(constant(std::log2(image.min_alpha))) {}

  HWY_INLINE Floats value_of(const Entry& entry, Floats x, Floats y) const {
    return DiscAt(entry, constants, x, y).log_alpha(entry);
  }
  HWY_INLINE Floats threshold_of(const Entry&) const { return min_log_alpha; }
  HWY_INLINE Floats alpha_of(const Entry&, Floats value) const {
    return exp2_of(hn::Max(value, min_log_alpha));
  }

  /// The values are q of DiscMoments, and the weight.
  HWY_INLINE void replay(const Entry& entry, BlockGradient& block, float* values,
                         float* sums) const {
    Floats h_sum = hn::Zero(d), screen_x = hn::Zero(d), screen_y = hn::Zero(d);
    for (std::size_t part = 0; part < parts; ++part) {
      const DiscAt at(entry, constants, block.x[part], block.y[part]);
      const auto [weight, h] = blend_again(*this, entry, at.log_alpha(entry), block, part);
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
      PixelValues<4>::store(times(hn::Neg(at.u)), times(hn::Neg(at.v)), times(at.squared), weight,
                            values + 4 * part * lanes);
    }
    sums[0] = hn::GetLane(hn::SumOfLanes(d, h_sum));
    sums[1] = hn::GetLane(hn::SumOfLanes(d, screen_x));
    sums[2] = hn::GetLane(hn::SumOfLanes(d, screen_y));
  }

  HWY_INLINE Moments moved(const Entry&, const float* line, float x, float y) const {
    return PixelValues<4>::moved(line, x, y);
  }
};

const TileFunctions<DiscEntry, DiscMoments>& disc_tile_functions_on() {
  return tile_functions<Discs>;
}

}  // namespace discs
using discs::disc_tile_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(disc_tile_functions_on);

const TileFunctions<splatting::DiscEntry, DiscMoments>& disc_tile_functions() {
  return HWY_DYNAMIC_DISPATCH(disc_tile_functions_on)();
}

}  // namespace tureen::trainer
#endif
