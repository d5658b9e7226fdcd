// Premultiplied splats over a background, against the equation of `over` in double precision.
#include "splatting/tiles/composite.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/random.hpp"

namespace tureen::splatting {
namespace composite_test {

/// The byte of a channel of one pixel.
int byte_of(const float* rgba, const glm::vec4& background, int channel) {
  const double through = 1 - double(rgba[3]);
  const double alpha = double(rgba[3]) + through * double(background.a);
  double value = alpha;
  if (channel < 3) {
    const double sum =
        double(rgba[channel]) + through * double(background.a) * double(background[channel]);
    value = alpha > 0 ? sum / alpha : double(background[channel]);
  }
  return int(std::nearbyint(255 * std::clamp(value, 0.0, 1.0)));
}

TEST(Composite, IsOverTheBackground) {
  test::Random random(1);
  // 37: full vectors of any width, and a rest.
  std::vector<float> rgba(4 * 37);
  for (std::size_t i = 0; i < rgba.size(); ++i)
    rgba[i] = float(i % 4 == 3 ? random.uniform(0, 1) : random.uniform(-0.1, 1.2));
  std::fill_n(rgba.begin(), 4, 0.0f);    // nothing
  std::fill_n(rgba.end() - 4, 4, 0.0f);  // and in the rest
  for (const glm::vec4& background :
       {glm::vec4(0.2f, 0.5f, 0.7f, 1), glm::vec4(1, 0.6f, 0.3f, 0.5f),
        glm::vec4(0.9f, 0.1f, 0, 0)}) {
    std::vector<std::uint32_t> colors(37);
    composite(rgba, background, colors);
    for (std::size_t i = 0; i < colors.size(); ++i)
      for (int channel = 0; channel < 4; ++channel)
        // One: a float just beside a half rounds to the other byte.
        EXPECT_NEAR(int(colors[i] >> (8 * channel) & 255),
                    byte_of(&rgba[4 * i], background, channel), 1)
            << "pixel " << i << ", channel " << channel;
  }
}

/// Exact bytes, without a tolerance.
TEST(Composite, HasKnownValues) {
  const std::vector<float> rgba = {0.25f, 0, 0, 0.5f, 0, 0, 0, 0, 1, 1, 1, 1};
  std::vector<std::uint32_t> colors(3);
  composite(rgba, {0, 1, 0, 1}, colors);
  EXPECT_EQ(colors, (std::vector<std::uint32_t>{0xff008040, 0xff00ff00, 0xffffffff}));
  composite(rgba, {0.4f, 1, 0, 0}, colors);
  EXPECT_EQ(colors, (std::vector<std::uint32_t>{0x80000080, 0x0000ff66, 0xffffffff}));
}

}  // namespace composite_test
}  // namespace tureen::splatting
