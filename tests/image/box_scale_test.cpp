#include "image/box_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec4.hpp>
#include <random>

namespace tureen {
namespace box_scale_test {

TEST(BoxScale, AveragesByArea) {
  Image8 image(3, 2, glm::u8vec4(0, 0, 0, 255));
  image.at(0, 0) = image.at(0, 1) = glm::u8vec4(255, 255, 255, 255);
  // Three columns become two: the first covers a white one and half a black one.
  const Image8 half = box_scaled(image, 2, 1);
  EXPECT_EQ(half.at(0, 0), glm::u8vec4(170, 170, 170, 255));
  EXPECT_EQ(half.at(1, 0), glm::u8vec4(0, 0, 0, 255));
}

TEST(BoxScale, TransparentPixelsDoNotDarken) {
  Image8 image(2, 1, glm::u8vec4(0));
  image.at(0, 0) = glm::u8vec4(200, 100, 50, 255);
  EXPECT_EQ(box_scaled(image, 1, 1).at(0, 0), glm::u8vec4(200, 100, 50, 128));
  EXPECT_EQ(box_scaled(Image8(4, 4, glm::u8vec4(9, 9, 9, 0)), 2, 2).at(1, 1), glm::u8vec4(0));
}

TEST(BoxScale, EnlargesToBlocksAndKeepsTheSameSize) {
  Image8 image(2, 1);
  image.at(0, 0) = glm::u8vec4(1, 2, 3, 255);
  image.at(1, 0) = glm::u8vec4(250, 251, 252, 255);
  const Image8 blocks = box_scaled(image, 6, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 6; ++x) EXPECT_EQ(blocks.at(x, y), image.at(x / 3, 0)) << x << ' ' << y;
  EXPECT_EQ(box_scaled(image, 2, 1).pixels, image.pixels);
}

/// The definition for one pixel: an integral over the covered rectangle.
glm::dvec4 mean_over(const Image8& image, double left, double top, double right, double bottom) {
  glm::dvec3 color(0);
  double alpha = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double area = std::max(0.0, std::min(right, x + 1.0) - std::max(left, double(x))) *
                          std::max(0.0, std::min(bottom, y + 1.0) - std::max(top, double(y)));
      const glm::dvec4 pixel(image.at(x, y));
      color += area * pixel.a * glm::dvec3(pixel);
      alpha += area * pixel.a;
    }
  return {alpha > 0 ? color / alpha : glm::dvec3(0), alpha / ((right - left) * (bottom - top))};
}

TEST(BoxScale, AgreesWithItsDefinitionOnRandomImages) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    const auto up_to = [&](int most) { return 1 + int(random() % unsigned(most)); };
    Image8 image(up_to(20), up_to(20));
    for (glm::u8vec4& pixel : image.pixels) {
      for (int c = 0; c < 4; ++c) pixel[c] = glm::u8(random());
      if (random() % 3 == 0) pixel.a = 0;
      if (random() % 3 == 0) pixel.a = 255;
    }
    const int width = up_to(20), height = up_to(20);
    const Image8 scaled = box_scaled(image, width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double sx = double(image.width) / width, sy = double(image.height) / height;
        const glm::dvec4 want = mean_over(image, x * sx, y * sy, (x + 1) * sx, (y + 1) * sy);
        // Rounding to a byte, plus less than 0.01 for sums of floats up to 255^2 with 24 bits.
        for (int c = 0; c < 4; ++c)
          EXPECT_NEAR(double(scaled.at(x, y)[c]), want[c], 0.51) << x << ' ' << y << ' ' << c;
      }
  }
}

}  // namespace box_scale_test
}  // namespace tureen
