#include "trainer/splats/gaussians/gaussian_tile_kernels.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/gaussians/gaussian_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/gaussians/gaussian_alpha-inl.hpp"
#include "trainer/splats/tile_loops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {

namespace gaussian_tiles {

using namespace tiles;
using splatting::GaussianEntry;

/// The kernel of the loops. A value is log2(alpha).
struct Gaussians {
  using Entry = GaussianEntry;
  using Moments = GaussianMoments;
  static constexpr std::size_t values_a_pixel = 2;
  static constexpr bool sums_squares = false;
  const ImageView& view;
  Floats min_log_alpha;

  Gaussians(const ImageView& image, float)
      : view(image), min_log_alpha(constant(std::log2(image.min_alpha))) {}

  HWY_INLINE Floats value_of(const Entry& entry, Floats x, Floats y) const {
    return log_alpha_of(entry, x, y);
  }
  HWY_INLINE Floats threshold_of(const Entry&) const { return min_log_alpha; }
  HWY_INLINE Floats alpha_of(const Entry&, Floats value) const {
    return exp2_of(hn::Max(value, min_log_alpha));
  }

  /// The values are h and the weight.
  HWY_INLINE void replay(const Entry& entry, BlockGradient& block, float* values, float*) const {
    for (std::size_t part = 0; part < parts; ++part) {
      const Floats value = value_of(entry, block.x[part], block.y[part]);
      const auto [weight, h] = blend_again(*this, entry, value, block, part);
      PixelValues<2>::store(h, weight, values + 2 * part * lanes);
    }
  }

  HWY_INLINE Moments moved(const Entry&, const float* line, float x, float y) const {
    Moments m;
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
};

const TileFunctions<GaussianEntry, GaussianMoments>& gaussian_tile_functions_on() {
  return tile_functions<Gaussians>;
}

}  // namespace gaussian_tiles
using gaussian_tiles::gaussian_tile_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(gaussian_tile_functions_on);

const TileFunctions<splatting::GaussianEntry, GaussianMoments>& gaussian_tile_functions() {
  return HWY_DYNAMIC_DISPATCH(gaussian_tile_functions_on)();
}

}  // namespace tureen::trainer
#endif
