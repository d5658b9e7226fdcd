#include "trainer/splats/window_tile_kernels.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/window_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/window_alpha-inl.hpp"
#include "trainer/splats/tile_loops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace windows {

using namespace tiles;
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
  blend_recorded(view, entries, tile, AlphaAlone{constant(1.0f / view.near)}, pixels, record);
}

constexpr std::size_t log_column = h_column + 1, weight_column = h_column + 2;

/// Blends an entry again, writes the four values of the block's pixels, and adds the sums that have
/// no factor to its line.
HWY_INLINE void replay(const ImageView& view, const WindowEntry& entry, BlockGradient& block,
                       float* fours, float* line) {
  const Floats one = constant(1.0f), max_alpha = constant(view.max_alpha);
  const Floats inverse_near = constant(1.0f / view.near);
  Floats h_sum = hn::Zero(d), log_sum = hn::Zero(d), weight_sum = hn::Zero(d);
  for (std::size_t part = 0; part < parts; ++part) {
    const WindowAt at(entry, block.x[part], block.y[part]);
    const Floats log_rho = log_rho_of(at.rho);
    const Floats unlimited = window_alpha_of(entry, log_rho);
    const Floats alpha = hn::Min(unlimited, max_alpha);
    // One division for alpha / (1 - alpha) and 1 / rho.
    const Floats rho = hn::Max(at.rho, constant(min_rho_in_gradient));
    const Floats left = hn::Sub(one, alpha);
    const Floats inverse = hn::Div(one, hn::Mul(left, rho));
    const Floats ratio = hn::Mul(alpha, hn::Mul(inverse, rho));
    const auto [weight, h] =
        blend_again(view, entry, covers(entry, at, inverse_near), unlimited, ratio, block, part);
    h_sum = hn::Add(h_sum, h);
    log_sum = hn::MulAdd(h, log_rho, log_sum);
    weight_sum = hn::Add(weight_sum, weight);
    // rho is at most 1: beyond, no edge moves alpha.
    const Floats by_rho =
        hn::IfThenElseZero(hn::Le(at.rho, one), hn::Mul(h, hn::Mul(inverse, left)));
    const Mask nearest_0 = hn::Eq(at.rho, at.distance[0]);
    const Mask nearest_1 = hn::AndNot(nearest_0, hn::Eq(at.rho, at.distance[1]));
    const Floats of_0 = hn::IfThenElseZero(nearest_0, by_rho);
    const Floats of_1 = hn::IfThenElseZero(nearest_1, by_rho);
    const Floats of_2 = hn::IfThenZeroElse(hn::Or(nearest_0, nearest_1), by_rho);
    hn::StoreInterleaved4(of_0, of_1, of_2, weight, d, fours + 4 * part * lanes);
  }
  line[h_column] += hn::GetLane(hn::SumOfLanes(d, h_sum));
  line[weight_column] += hn::GetLane(hn::SumOfLanes(d, weight_sum));
  line[log_column] += hn::GetLane(hn::SumOfLanes(d, log_sum));
}

/// Moves the origin of moments from the middle of a tile to the entry's (x, y), `x` and `y` pixels
/// before it. `by_square`: TileGradient's.
HWY_INLINE WindowMoments moved(const WindowEntry& entry, float by_square, const float* line,
                               float x, float y) {
  WindowMoments m;
  for (std::size_t k = 0; k < 3; ++k)
    m.edges[k] = {line[k], line[4 + k] + x * line[k], line[8 + k] + y * line[k]};
  m.h = line[h_column];
  m.h_log_rho = line[log_column];
  const float by_color = 2 * by_square * line[weight_column];
  m.red = line[3] + by_color * entry.red;
  m.green = line[7] + by_color * entry.green;
  m.blue = line[11] + by_color * entry.blue;
  m.evident = line[evident_column];
  m.unused = 0;
  return m;
}

void blend_windows_backward_on(const ImageView& view, std::span<const WindowEntry> entries,
                               std::span<const std::uint32_t> tile,
                               std::span<const std::uint32_t> numbers, const TileRecord& record,
                               TileGradient& gradient, TileScratch& scratch,
                               std::span<WindowMoments> moments) {
  blend_backward(
      entries, tile, numbers, record, gradient, scratch, moments,
      [&](const WindowEntry& entry, BlockGradient& block, float* fours, float* line) {
        replay(view, entry, block, fours, line);
      },
      [&](const WindowEntry& entry, const float* line, float x, float y) {
        return moved(entry, gradient.by_square, line, x, y);
      });
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
                            TileGradient& gradient, TileScratch& scratch,
                            std::span<WindowMoments> moments) {
  HWY_DYNAMIC_DISPATCH(blend_windows_backward_on)
  (view, entries, tile, numbers, record, gradient, scratch, moments);
}

}  // namespace tureen::trainer
#endif
