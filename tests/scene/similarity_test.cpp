// Similarities as numbers: known matrices, and matrices that come back from their numbers.
#include "scene/similarity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "scene/scene.hpp"

namespace tureen {
namespace similarity_test {

void expect_near(const glm::dmat4& actual, const glm::dmat4& expected, double tolerance) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_NEAR(actual[column][row], expected[column][row], tolerance)
          << "column " << column << ", row " << row;
}

glm::dvec3 moved(const Similarity& similarity, const glm::dvec3& point) {
  return glm::dvec3(matrix_of(similarity) * glm::dvec4(point, 1.0));
}

TEST(Similarity, RotatesAboutXThenYThenZ) {
  // x: (0, 1, 0) becomes (0, 0, 1); y: that becomes (1, 0, 0); z: that becomes (0, 1, 0).
  EXPECT_LT(glm::length(moved({.angles = {90, 0, 0}}, {0, 1, 0}) - glm::dvec3(0, 0, 1)), 1e-15);
  EXPECT_LT(glm::length(moved({.angles = {90, 90, 0}}, {0, 1, 0}) - glm::dvec3(1, 0, 0)), 1e-15);
  EXPECT_LT(glm::length(moved({.angles = {90, 90, 90}}, {0, 1, 0}) - glm::dvec3(0, 1, 0)), 1e-15);
}

TEST(Similarity, MirrorsXBeforeTheRotationAndTranslatesLast) {
  const Similarity all{.position = {10, 20, 30}, .angles = {0, 0, 90}, .scale = 2, .mirror = true};
  EXPECT_LT(glm::length(moved(all, {1, 0, 0}) - glm::dvec3(10, 18, 30)), 1e-14);
  EXPECT_LT(glm::determinant(glm::dmat3(matrix_of(all))), 0);
}

TEST(Similarity, TheIdentityIsExact) {
  EXPECT_EQ(matrix_of({}), glm::dmat4(1.0));
  const Similarity numbers = similarity_of(at_origin({1e7, 0.1, -3}));
  EXPECT_EQ(numbers.position, glm::dvec3(1e7, 0.1, -3));
  EXPECT_EQ(numbers.angles, glm::dvec3(0.0));
  EXPECT_EQ(numbers.scale, 1.0);
  EXPECT_FALSE(numbers.mirror);
}

TEST(Similarity, NumbersComeBack) {
  constexpr unsigned seed = 20261125;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const Similarity numbers{.position = {unit(random), unit(random), unit(random)},
                             .angles = {179 * unit(random), 89 * unit(random), 179 * unit(random)},
                             .scale = std::exp(10 * unit(random)),
                             .mirror = i % 2 == 1};
    const Similarity back = similarity_of(matrix_of(numbers));
    EXPECT_EQ(back.position, numbers.position);
    EXPECT_LT(glm::length(back.angles - numbers.angles), 1e-10) << "seed " << seed << ", " << i;
    EXPECT_NEAR(back.scale / numbers.scale, 1, 1e-14);
    EXPECT_EQ(back.mirror, numbers.mirror);
  }
}

// Where x and z have the same axis, the numbers may differ, but not the matrix.
TEST(Similarity, TheMatrixComesBackAtAndNearTheEndsOfY) {
  for (const double y : {90.0, -90.0, 90 - 1e-7, -90 + 1e-7, 90 - 1e-10})
    for (const bool mirror : {false, true}) {
      const glm::dmat4 matrix = matrix_of({.angles = {35, y, -170}, .mirror = mirror});
      expect_near(matrix_of(similarity_of(matrix)), matrix, 1e-14);
    }
}

TEST(Similarity, RoundingNoiseOfThePositionIsPrintedAsZero) {
  EXPECT_EQ(describe(Similarity{.position = {-1.6e-16, 2, 3e-15}}), "at (0, 2, 0)");
  EXPECT_EQ(describe(Similarity{.position = {-1.6e-16, 0, 0}}), "at (0, 0, 0)");
  EXPECT_EQ(describe(Similarity{.position = {1e-9, 1e6, 0}}), "at (0, 1e+06, 0)");
  EXPECT_EQ(describe(Similarity{.position = {1e-12, 2, 0}}), "at (1e-12, 2, 0)");
  EXPECT_EQ(describe(Similarity{.position = {1e-16, 0, 0}, .scale = 1e-9}).substr(0, 15),
            "at (1e-16, 0, 0");
}

TEST(Similarity, TinyAndHugeScalesComeBack) {
  for (const double scale : {1e-150, 1e150}) {
    const Similarity back = similarity_of(matrix_of({.scale = scale, .mirror = true}));
    EXPECT_NEAR(back.scale / scale, 1, 1e-14);
    EXPECT_TRUE(back.mirror);
  }
}

}  // namespace similarity_test
}  // namespace tureen
