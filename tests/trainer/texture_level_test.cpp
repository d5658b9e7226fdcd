#include "trainer/diffsoup/texture_level.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace tureen::trainer {
namespace {

/// Two photographs of `width` x `width`, in which an eighth of the rows is covered.
Dataset dataset(int width) {
  Dataset data;
  for (int i = 0; i < 2; ++i) {
    Photograph& photograph = data.train.emplace_back();
    Image8 image(width, width);
    for (int y = 0; y < width / 8; ++y)
      for (int x = 0; x < width; ++x) image.at(x, y).a = 255;
    photograph.image = std::move(image);
  }
  return data;
}

TEST(TextureLevel, HasAFewTexelsForEachPixelOfATriangle) {
  // 512 * 64 = 2^15 covered pixels: 2^n triangles have 2^(16 - n) each. Three and a half texels for
  // each of those are 3.5 * 2^(16 - n); level L has about 2^(2 L - 1).
  EXPECT_EQ(fitting_level(dataset(512), 1 << 8), 5);
  EXPECT_EQ(fitting_level(dataset(512), 1 << 10), 4);
  EXPECT_EQ(fitting_level(dataset(512), 1 << 12), 3);
  EXPECT_EQ(fitting_level(dataset(256), 1 << 10), 3) << "a quarter of the pixels";
  // Level 4 begins where 7 p = 4^3.5, at p = 18.3 pixels a triangle: 2^16 / p = 3,584 triangles.
  EXPECT_EQ(fitting_level(dataset(512), 3500), 4);
  EXPECT_EQ(fitting_level(dataset(512), 3700), 3);
  EXPECT_EQ(fitting_level(dataset(512), 1), highest_automatic_level);
  EXPECT_EQ(fitting_level(dataset(512), 1 << 20), 3) << "the lowest";
  EXPECT_EQ(fitting_level({}, 100), 3) << "no photograph";
}

TEST(TextureLevel, LeavesOutIgnoredPixels) {
  Dataset data = dataset(512);
  for (Photograph& photograph : data.train) {
    std::vector<std::uint8_t> ignored(512 * 512, 0);
    std::fill_n(ignored.begin(), 512 * 48, 1);  // three quarters of the covered ones
    photograph.ignored = std::move(ignored);
  }
  EXPECT_EQ(fitting_level(data, 1 << 10), 3);
}

TEST(TextureLevel, ChangesOnlyTheAutomaticOne) {
  Config config = preset(Preset::object);
  config.triangles = 1 << 8;
  EXPECT_EQ(with_fitting_level(config, dataset(512)).max_level, 5);
  config.max_level = 1;
  EXPECT_EQ(with_fitting_level(config, dataset(512)).max_level, 1);
  config.max_level = automatic_level;
  config.min_level = 6;
  EXPECT_EQ(with_fitting_level(config, dataset(512)).max_level, 6) << "never below the coarsest";
}

}  // namespace
}  // namespace tureen::trainer
