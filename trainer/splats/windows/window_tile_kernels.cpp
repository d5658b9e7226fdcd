#include "trainer/splats/windows/window_tile_kernels.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/windows/window_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/windows/window_alpha-inl.hpp"
#include "trainer/splats/tile_loops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace windows {

using namespace tiles;
using splatting::WindowEntry;

/// The kernel of the loops. A value is rho.
struct Windows {
  using Entry = WindowEntry;
  using Moments = WindowMoments;
  static constexpr std::size_t values_a_pixel = 4;
  static constexpr bool sums_squares = true;
  const ImageView& view;
  float by_square;  // TileGradient's

  Windows(const ImageView& image, float square) : view(image), by_square(square) {}

  HWY_INLINE Floats value_of(const Entry& entry, Floats x, Floats y) const {
    return visible_rho(entry, WindowAt(entry, x, y));
  }
  HWY_INLINE Floats threshold_of(const Entry& entry) const { return constant(entry.min_rho); }
  HWY_INLINE Floats alpha_of(const Entry& entry, Floats value) const {
    return window_alpha_of(entry, log_rho_of(value));
  }

  /// rho, or -infinity nearer than the near plane and behind the eye.
  HWY_INLINE Floats visible_rho(const Entry& entry, const WindowAt& at) const {
    if (!entry.reaches_near) return at.rho;
    const Floats inverse_depth = at.linear(entry.inverse_depth);
    const Mask seen = hn::And(hn::Gt(inverse_depth, hn::Zero(d)),
                              hn::Lt(inverse_depth, constant(1.0f / view.near)));
    return hn::IfThenElse(seen, at.rho, constant(-std::numeric_limits<float>::infinity()));
  }

  /// The values are h / rho at the pixels nearest to each edge, and the weight.
  HWY_INLINE void replay(const Entry& entry, BlockGradient& block, float* values,
                         float* sums) const {
    const Floats one = constant(1.0f), max_alpha = constant(view.max_alpha);
    Floats h_sum = hn::Zero(d), log_sum = hn::Zero(d), weight_sum = hn::Zero(d);
    for (std::size_t part = 0; part < parts; ++part) {
      const WindowAt at(entry, block.x[part], block.y[part]);
      const Mask covered = hn::Ge(visible_rho(entry, at), threshold_of(entry));
      const Floats log_rho = log_rho_of(at.rho);
      const Floats unlimited = window_alpha_of(entry, log_rho);
      const Floats alpha = hn::Min(unlimited, max_alpha);
      // One division for alpha / (1 - alpha) and 1 / rho.
      const Floats rho = hn::Max(at.rho, constant(min_rho_in_gradient));
      const Floats left = hn::Sub(one, alpha);
      const Floats inverse = hn::Div(one, hn::Mul(left, rho));
      const Floats ratio = hn::Mul(alpha, hn::Mul(inverse, rho));
      const auto [weight, h] = blend_again(view, entry, covered, unlimited, ratio, block, part);
      h_sum = hn::Add(h_sum, h);
      log_sum = hn::MulAdd(h, log_rho, log_sum);
      weight_sum = hn::Add(weight_sum, weight);
      // rho is at most 1: beyond, no edge moves alpha.
      const Floats by_rho =
          hn::IfThenElseZero(hn::Le(at.rho, one), hn::Mul(h, hn::Mul(inverse, left)));
      const Mask nearest_0 = hn::Eq(at.rho, at.distance[0]);
      const Mask nearest_1 = hn::AndNot(nearest_0, hn::Eq(at.rho, at.distance[1]));
      PixelValues<4>::store(hn::IfThenElseZero(nearest_0, by_rho),
                            hn::IfThenElseZero(nearest_1, by_rho),
                            hn::IfThenZeroElse(hn::Or(nearest_0, nearest_1), by_rho), weight,
                            values + 4 * part * lanes);
    }
    sums[0] = hn::GetLane(hn::SumOfLanes(d, h_sum));
    sums[1] = hn::GetLane(hn::SumOfLanes(d, log_sum));
    if (by_square > 0) sums[2] = hn::GetLane(hn::SumOfLanes(d, weight_sum));
  }

  HWY_INLINE Moments moved(const Entry& entry, const float* line, float x, float y) const {
    Moments m = PixelValues<4>::moved(line, x, y);
    if (by_square > 0) {
      const float by_color = 2 * by_square * m.others[1];  // times the sum of the weights
      m.one.color += by_color * entry.red;
      m.x.color += by_color * entry.green;
      m.y.color += by_color * entry.blue;
    }
    return m;
  }
};

const TileFunctions<WindowEntry, WindowMoments>& window_tile_functions_on() {
  return tile_functions<Windows>;
}

}  // namespace windows
using windows::window_tile_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(window_tile_functions_on);

const TileFunctions<splatting::WindowEntry, WindowMoments>& window_tile_functions() {
  return HWY_DYNAMIC_DISPATCH(window_tile_functions_on)();
}

}  // namespace tureen::trainer
#endif
