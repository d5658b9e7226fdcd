#include "trainer/common/plain_background.hpp"

#include <gtest/gtest.h>

namespace tureen::trainer {
namespace {

/// Ten photographs with a border of `colour`; in the first `other`, the top row is black.
Dataset photographs(glm::u8vec3 colour, int other) {
  Dataset dataset;
  for (int i = 0; i < 10; ++i) {
    Image8 image(20, 30, glm::u8vec4(40, 80, 120, 255));
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 20; ++x)
        if (x == 0 || y == 0 || x == 19 || y == 29)
          image.at(x, y) = glm::u8vec4(colour, 255) + glm::u8vec4((x + y) % 5, 0, 0, 0);
    for (int x = 0; i < other && x < 20; ++x) image.at(x, 0) = glm::u8vec4(0, 0, 0, 255);
    dataset.train.push_back({.camera = {}, .image = std::move(image)});
  }
  return dataset;
}

TEST(PlainBackground, IsTheColourOfTheBorders) {
  const auto colour = plain_background(photographs({200, 220, 240}, 1));
  ASSERT_TRUE(colour);
  EXPECT_NEAR(colour->r, 202 / 255.0, 1e-6);  // the median of 200 .. 204
  EXPECT_NEAR(colour->g, 220 / 255.0, 1e-6);
  EXPECT_NEAR(colour->b, 240 / 255.0, 1e-6);
}

TEST(PlainBackground, IsMissingInPhotographsOfAPlace) {
  // Three of ten top rows are 6 % of the border.
  EXPECT_FALSE(plain_background(photographs({200, 220, 240}, 3)));
  EXPECT_FALSE(plain_background({}));
}

}  // namespace
}  // namespace tureen::trainer
