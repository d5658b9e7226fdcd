// The largest colour of splats, and the formats in which they are blended.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "runtime/plan/splat_plan.hpp"
#include "runtime/splats/splat_target.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace splat_formats_test {

TEST(SplatPlan, BoundsTheColoursOfEveryDirection) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (const int degree : {0, 1, 2, 3, 4}) {
    Splats splats = random_splats(splat_kinds[1], 50, 0.1, 1);
    const auto per_splat = std::size_t(harmonics::count(degree));
    splats.color = {.degree = degree};
    for (std::size_t i = 0; i < 50 * per_splat; ++i)
      splats.color.coefficients.emplace_back(normal(random), normal(random), normal(random));
    const float bound = make_splat_plan(splats).largest_color;
    float largest = 1;
    for (int direction = 0; direction < 2000; ++direction) {
      const auto basis = harmonics::basis(
          glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
      for (std::size_t i = 0; i < 50; ++i) {
        glm::vec3 color(0.5f);
        for (std::size_t k = 0; k < per_splat; ++k)
          color += basis[k] * splats.color.coefficients[per_splat * i + k];
        largest = std::max({largest, color.x, color.y, color.z});
      }
    }
    EXPECT_LE(largest, bound * 1.00001f) << degree;  // rounding of floats
    // Of 50 splats and 2000 directions, some are near the largest. Higher bands have sharper peaks.
    EXPECT_GT(largest, 0.5f * bound) << degree;
  }
}

TEST(SplatTarget, HasFractionsWhereTheyAreExactEnough) {
  gl::Capabilities device;
  device.float_blending = device.norm16_targets = true;
  const auto format = [&](SplatFormat requested, float min_alpha, float largest_color) {
    return blend_format(requested, device, min_alpha, largest_color).texture.internal_format;
  };
  constexpr float min_alpha = 1.0f / 255;
  const GLenum fractions = target_formats::rgba16.internal_format;
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 2), fractions);
  EXPECT_EQ(blend_format(SplatFormat::automatic, device, min_alpha, 2).color_unit, 0.5f);
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 9), GL_RGBA32F);
  EXPECT_EQ(format(SplatFormat::automatic, 1e-4f, 2), GL_RGBA32F);
  EXPECT_EQ(format(SplatFormat::rgba32f, min_alpha, 2), GL_RGBA32F);
  EXPECT_EQ(format(SplatFormat::rgba16f, min_alpha, 2), GL_RGBA16F);
  device.norm16_targets = false;
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 2), GL_RGBA32F);
  device.float_blending = false;
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 2), GL_RGBA16F);
}

}  // namespace splat_formats_test
}  // namespace tureen::test
