// Projection compared with rays: e_k = b_k / w of the triangle's edge functions, in float, and the
// intersection of a pixel's ray with the triangle's plane, in double.
#include "trainer/common/kernels/projection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/trainer/ray_triangle.hpp"

namespace tureen::trainer {
namespace projection_test {

using tureen::test::Random;

constexpr int width = 64, height = 48;

// For every kind of triangle, edge functions agree with the rays wherever rounding allows a
// decision, and few pixels are undecided.
class ProjectionOf : public testing::TestWithParam<test::TriangleKind> {};

TEST_P(ProjectionOf, AgreesWithRays) {
  const std::uint64_t seed = 100 + std::uint64_t(GetParam());
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  int hits = 0, doubtful = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const kernels::View view = test::random_view(random, width, height);
    float corners[9];
    test::random_triangle(random, view, GetParam(), corners);
    const kernels::ProjectedFace face = kernels::project(view, corners);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const test::RayHit ray = test::intersect(view, corners, x, y);
        const bool inside = x >= face.x0 && x < face.x1 && y >= face.y0 && y < face.y1;
        if (!inside) {
          // No ray through a pixel outside the rectangle clearly hits.
          if (test::hits(ray, view)) {
            const double margin = std::min({ray.e[0], ray.e[1], ray.e[2]});
            const double scale = std::max({ray.slope[0], ray.slope[1], ray.slope[2]});
            // A ten-thousandth of a pixel from an edge, or from the near plane.
            ASSERT_TRUE(margin < 1e-4 * scale || ray.inverse_depth > (1 - 1e-4) / view.near ||
                        ray.inverse_depth < (1 + 1e-4) / view.far)
                << "trial " << trial << ", pixel " << x << ", " << y;
            ++doubtful;
          }
          continue;
        }
        float e[3];
        kernels::edge_values(face, float(x), float(y), e);
        const auto bounds = test::rounding_bounds(face, x, y);
        for (int k = 0; k < 3; ++k)
          ASSERT_NEAR(e[k], ray.e[k], bounds[k])
              << "trial " << trial << ", pixel " << x << ", " << y << ", edge " << k;
        if (test::hits(ray, view)) ++hits;
      }
  }
  if (test::is_drawn(GetParam()))
    EXPECT_GT(hits, 100);
  else
    EXPECT_EQ(hits, 0);
  EXPECT_LE(doubtful, hits / 100);
}

INSTANTIATE_TEST_SUITE_P(, ProjectionOf, testing::ValuesIn(test::triangle_kinds),
                         [](const auto& tested) { return test::name(tested.param); });

TEST(Projection, TrianglesThatCannotBeSeenAreEmpty) {
  const kernels::View view = test::plain_view(width, height);
  const auto empty = [&](const float(&corners)[9]) { return project(view, corners).empty(); };
  EXPECT_FALSE(empty({-1, -1, 2, 1, -1, 2, 0, 1, 2}));
  EXPECT_TRUE(empty({-1, -1, -2, 1, -1, -2, 0, 1, -2})) << "behind the eye";
  EXPECT_TRUE(empty({100, 0, 2, 101, 0, 2, 100, 1, 2})) << "to the right of the image";
  EXPECT_TRUE(empty({0, 100, 2, 1, 100, 2, 0, 101, 2})) << "below the image";
  EXPECT_TRUE(empty({1, 1, 2, 1, 1, 2, 1, 1, 2})) << "a point";
  EXPECT_TRUE(empty({0, 0, 2, 0.25f, 0, 2, 0.5f, 0, 2})) << "collinear corners";
  EXPECT_TRUE(empty({0, 0, 1, 0, 0, 2, 0, 1, 3})) << "edge-on: the eye is in its plane";
}

TEST(Projection, NumbersThatAreNoneAreEmptyWhereverTheyStand) {
  const kernels::View view = test::plain_view(width, height);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()})
    for (int number = 0; number < 9; ++number) {
      float corners[9] = {-1, -1, 2, 1, -1, 2, 0, 1, 2};
      corners[number] = bad;
      EXPECT_TRUE(project(view, corners).empty()) << bad << " in place of number " << number;
    }
}

TEST(Projection, TheEyesPlaneAndHugeCoordinatesAreSafe) {
  // Depths of exactly 0 and next to it, and coordinates with products that overflow. No cast may
  // overflow (checked by the sanitizers), and a rectangle that is not empty lies within the image.
  Random random(7);
  const kernels::View view = test::plain_view(width, height);
  const float depths[] = {0.0f, 1e-30f, -1e-30f, -1.0f, 1e-38f, 0.01f, 1.0f, 1e30f, 3e38f};
  const float sides[] = {0.0f, 1e-30f, 1.0f, -1.0f, 1e10f, -1e30f, 3e38f};
  for (int trial = 0; trial < 20'000; ++trial) {
    float corners[9];
    for (int i = 0; i < 9; ++i)
      corners[i] = i % 3 == 2 ? depths[random.below(9)] : sides[random.below(7)];
    const kernels::ProjectedFace face = kernels::project(view, corners);
    if (face.empty()) continue;
    ASSERT_TRUE(face.x0 >= 0 && face.y0 >= 0 && face.x1 <= width && face.y1 <= height);
    ASSERT_LT(face.y0, face.y1);
    for (int k = 0; k < 3; ++k)
      ASSERT_TRUE(std::isfinite(face.c[k]) && std::isfinite(face.dx[k]) &&
                  std::isfinite(face.dy[k]));
  }
}

}  // namespace projection_test
}  // namespace tureen::trainer
