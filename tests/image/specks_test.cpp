#include "image/specks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/random.hpp"

namespace tureen::test {
namespace specks_test {

constexpr int width = 37, height = 21;  // neither is a multiple of the vectors' lanes

ImageF random_image(std::uint64_t seed) {
  Random random(seed);
  ImageF image(width, height);
  // Few values, so that many are equal.
  for (glm::vec4& pixel : image.pixels)
    pixel = glm::vec4(random.below(6), random.below(40), random.uniform(), 1) / 40.0f;
  return image;
}

float difference_by_sorting(const ImageF& image, int column, int row) {
  float largest = 0;
  for (int c = 0; c < 3; ++c) {
    std::vector<float> values;
    for (int y = row - 2; y <= row + 2; ++y)
      for (int x = column - 2; x <= column + 2; ++x)
        values.push_back(image.at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1))[c]);
    std::sort(values.begin(), values.end());
    largest = std::max(largest, std::abs(image.at(column, row)[c] - values[12]));
  }
  return largest;
}

TEST(Specks, DifferFromTheMedianOfTheirNeighbours) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ImageF image = random_image(seed);
    const std::vector<float> differences = differences_from_median(image);
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column)
        ASSERT_EQ(differences[std::size_t(row * width + column)],
                  difference_by_sorting(image, column, row))
            << seed << ", " << column << ", " << row;
  }
}

TEST(Specks, CountOnlyWhereThePhotographIsCalm) {
  const ImageF grey(width, height, {0.5f, 0.5f, 0.5f, 1});
  ImageF drawn = grey;
  drawn.at(10, 10).g = 0.34f;  // 0.16 below the median
  drawn.at(20, 10).g = 0.36f;  // 0.14
  drawn.at(30, 10).b = 0.9f;
  ImageF photograph = grey;
  photograph.at(30, 10).r = 0.56f;  // the photograph has detail there, in any channel
  const std::vector<float> map = speck_map(photograph, drawn);
  EXPECT_EQ(map[10 * width + 10], 1);
  EXPECT_EQ(std::accumulate(map.begin(), map.end(), 0.0f), 1);
}

TEST(Specks, LargeAreasAreNoSpecks) {
  const ImageF grey(width, height, {0.5f, 0.5f, 0.5f, 1});
  ImageF drawn = grey;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width / 2; ++column) drawn.at(column, row) = glm::vec4(1);
  EXPECT_THAT(speck_map(grey, drawn), testing::Each(0));
}

TEST(Holes, AreThePartThatShowsTheBackgroundInsideTheSilhouette) {
  ImageF photograph(4, 1, glm::vec4(1)), drawn(4, 1, glm::vec4(1));
  photograph.pixels[2].a = 0.5f;  // at the edge of the silhouette
  photograph.pixels[3].a = 0;
  drawn.pixels[1].a = 0.25f;
  drawn.pixels[2].a = drawn.pixels[3].a = 0;
  EXPECT_THAT(hole_map(photograph, drawn), testing::ElementsAre(0, 0.75f, 0, 0));
}

TEST(Specks, AreMarked) {
  const ImageF grey(width, height, {0.5f, 0.5f, 0.5f, 1});
  ImageF drawn = grey;
  drawn.at(10, 10) = {1, 1, 1, 1};
  drawn.at(20, 10).a = 0;
  const Image8 marked = marked_defects(grey, drawn);
  EXPECT_EQ(marked.at(0, 0), glm::u8vec4(51, 51, 51, 255));
  EXPECT_EQ(marked.at(10, 10), glm::u8vec4(255, 255, 0, 255));
  EXPECT_EQ(marked.at(20, 10), glm::u8vec4(255, 0, 255, 255));
}

}  // namespace specks_test
}  // namespace tureen::test
