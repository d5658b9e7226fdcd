// The scale of differences, and maps of the differences between images.
#include "image/heat_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"

namespace tureen {
namespace heat_map_test {

TEST(HeatMap, GetsLighterWithTheDifference) {
  EXPECT_EQ(heat(0), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(heat(1), glm::u8vec4(255));
  int last = 0;
  for (int byte = 1; byte < 256; ++byte) {
    const glm::u8vec4 color = heat(float(byte) / 255);
    const int lightness = 2 * color.r + 5 * color.g + color.b;
    EXPECT_GE(lightness, last) << byte;
    last = lightness;
  }
}

/// The scale is logarithmic: violet at one step, white at 255 steps.
TEST(HeatMap, HasKnownColours) {
  EXPECT_EQ(heat(0.49f / 255), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(heat(1.0f / 255), glm::u8vec4(46, 13, 97, 255));
  EXPECT_EQ(heat(std::pow(1.0f / 255, 0.5f)), glm::u8vec4(230, 71, 51, 255));
  EXPECT_EQ(heat(std::pow(1.0f / 255, 0.25f)), glm::u8vec4(252, 184, 56, 255));
  EXPECT_EQ(heat(1), glm::u8vec4(255));
}

TEST(HeatMap, TheRampEndsWhereItSays) {
  EXPECT_EQ(heat_ramp(-1), heat_ramp(0));
  EXPECT_EQ(heat_ramp(2), glm::vec3(1));
  EXPECT_LT(heat_ramp(0).g, heat_ramp(0.5f).g);
}

TEST(HeatMap, ShowsTheLargestDifferenceOfEachPixel) {
  ImageF a(3, 2, glm::vec4(0.5f)), b = a;
  b.at(1, 0).g = 0.75f;
  b.at(2, 1).r = 0.0f;
  b.at(2, 1).b = 0.6f;
  const Image8 map = difference(a, b);
  ASSERT_EQ(map.width, 3);
  ASSERT_EQ(map.height, 2);
  EXPECT_EQ(map.at(0, 0), heat(0));
  EXPECT_EQ(map.at(1, 0), heat(0.25f));
  EXPECT_EQ(map.at(2, 1), heat(0.5f));
  const Image8 all = side_by_side(a, b);
  ASSERT_EQ(all.width, 9);
  EXPECT_EQ(all.at(4, 0), quantised(b).at(1, 0));
  EXPECT_EQ(all.at(2, 1), quantised(a).at(2, 1));
  EXPECT_EQ(all.at(8, 1), map.at(2, 1));
  EXPECT_THROW(difference(a, ImageF(2, 3)), UsageError);
}

TEST(HeatMap, TheLegendHasTheColoursOfTheScale) {
  const Legend legend = difference_legend();
  ASSERT_GE(legend.size(), 2u);
  EXPECT_EQ(legend.front().text, "0/255");
  EXPECT_EQ(legend.front().color, heat(0));
  EXPECT_EQ(legend.back().text, "255/255");
  EXPECT_EQ(legend.back().color, heat(1));
}

}  // namespace heat_map_test
}  // namespace tureen
