#include "trainer/common/kernels/fragments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "tests/trainer/fragments.hpp"
#include "tests/trainer/ray_triangle.hpp"

namespace tureen::trainer {
namespace fragments_test {

using kernels::Fragment;
using tureen::test::Random;

constexpr int width = 61, height = 45;  // not multiples of any block size

std::vector<Fragment> fragments(const kernels::View& view, const kernels::ProjectedFace& face,
                                const kernels::Rectangle& within) {
  std::vector<Fragment> result;
  test::for_each_fragment(view, face, within, [&](const Fragment& f) { result.push_back(f); });
  return result;
}

class FragmentsOf : public testing::TestWithParam<test::TriangleKind> {};

TEST_P(FragmentsOf, AreThePixelsThatRaysHit) {
  const std::uint64_t seed = 200 + std::uint64_t(GetParam());
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  int hits = 0, doubtful = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const kernels::View view = test::random_view(random, width, height);
    float corners[9];
    test::random_triangle(random, view, GetParam(), corners);
    const kernels::ProjectedFace face = kernels::project(view, corners);
    std::map<std::pair<int, int>, Fragment> found;
    for (const Fragment& f : fragments(view, face, {0, 0, width, height}))
      ASSERT_TRUE(found.emplace(std::pair(f.x, f.y), f).second) << "found twice";
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const test::RayHit ray = test::intersect(view, corners, x, y);
        const auto bounds = test::rounding_bounds(face, x, y);
        const double sum_bound = bounds[0] + bounds[1] + bounds[2] + 4e-7 / view.near;
        bool doubt = std::abs(ray.inverse_depth - 1 / view.near) < sum_bound ||
                     std::abs(ray.inverse_depth - 1 / view.far) < sum_bound;
        for (std::size_t k = 0; k < 3; ++k)
          // A ten-thousandth of a pixel: the rectangle is computed from rounded corners.
          doubt = doubt || std::abs(ray.e[k]) < bounds[k] + 1e-4 * ray.slope[k];
        const auto at = found.find({x, y});
        if (doubt) {
          ++doubtful;
          continue;
        }
        ASSERT_EQ(at != found.end(), test::hits(ray, view))
            << "trial " << trial << ", pixel " << x << ", " << y;
        if (at == found.end()) continue;
        ++hits;
        const Fragment& f = at->second;
        const double error = (bounds[0] + bounds[1] + bounds[2]) / ray.inverse_depth + 4e-7;
        // Fractions of a sum, each with its error bound.
        ASSERT_NEAR(f.b0, ray.e[0] / ray.inverse_depth, 2 * error);
        ASSERT_NEAR(f.b1, ray.e[1] / ray.inverse_depth, 2 * error);
        ASSERT_NEAR(f.inverse_depth / ray.inverse_depth, 1, error);
      }
  }
  if (test::is_drawn(GetParam()))
    EXPECT_GT(hits, 100);
  else
    EXPECT_EQ(hits, 0);
  // Of 300 x 61 x 45 pixels; a needle's line passes within rounding distance of some.
  EXPECT_LT(doubtful, 300 * width * height / 1000);
}

INSTANTIATE_TEST_SUITE_P(, FragmentsOf, testing::ValuesIn(test::triangle_kinds),
                         [](const auto& tested) { return test::name(tested.param); });

TEST(Fragments, AreTheSameHoweverTheImageIsDivided) {
  Random random(8);
  int total = 0;
  for (const test::TriangleKind kind : test::triangle_kinds)
    for (int trial = 0; trial < 20; ++trial) {
      const kernels::View view = test::random_view(random, width, height);
      float corners[9];
      test::random_triangle(random, view, kind, corners);
      const kernels::ProjectedFace face = kernels::project(view, corners);
      const auto whole = fragments(view, face, {0, 0, width, height});
      total += int(whole.size());
      for (const auto& [tile_width, tile_height] :
           {std::pair(1, 1), std::pair(7, 5), std::pair(8, 8), std::pair(32, 32)}) {
        std::vector<Fragment> parts;
        for (int y = 0; y < height; y += tile_height)
          for (int x = 0; x < width; x += tile_width)
            for (const Fragment& f : fragments(
                     view, face,
                     {x, y, std::min(x + tile_width, width), std::min(y + tile_height, height)})) {
              ASSERT_TRUE(f.x >= x && f.x < x + tile_width && f.y >= y && f.y < y + tile_height);
              parts.push_back(f);
            }
        std::ranges::sort(parts, {}, [](const Fragment& f) { return std::pair(f.y, f.x); });
        ASSERT_EQ(parts.size(), whole.size()) << tile_width << " x " << tile_height;
        for (std::size_t i = 0; i < whole.size(); ++i)
          ASSERT_TRUE(parts[i].x == whole[i].x && parts[i].y == whole[i].y &&
                      parts[i].b0 == whole[i].b0 && parts[i].b1 == whole[i].b1 &&
                      parts[i].inverse_depth == whole[i].inverse_depth);
      }
    }
  EXPECT_GT(total, 1000);
}

TEST(Fragments, LieBetweenTheNearAndTheFarPlane) {
  kernels::View view = test::plain_view(width, height);
  view.near = 1;
  view.far = 3;
  // A floor from behind the eye to beyond the far plane.
  const float corners[9] = {-50, 1, -10, 50, 1, -10, 0, 1, 90};
  const kernels::ProjectedFace face = kernels::project(view, corners);
  const auto found = fragments(view, face, {0, 0, width, height});
  ASSERT_FALSE(found.empty());
  for (const Fragment& f : found) {
    EXPECT_LE(f.inverse_depth, 1.0f);
    EXPECT_GE(f.inverse_depth, 1 / 3.0f);
    // The depth of the floor at a row: fy / (y + 1/2 - cy).
    EXPECT_NEAR(1 / f.inverse_depth, 50 / (f.y + 0.5 - height / 2.0), 1e-4) << "row " << f.y;
  }
}

TEST(Fragments, CentersOnEdgesBelong) {
  // An edge runs exactly through pixel centres: edge values are exactly 0 there.
  kernels::View view = test::plain_view(64, 64);
  view.fx = view.fy = 32;
  view.cx = view.cy = 32.5;  // the ray of pixel 32 is the axis
  const float corners[9] = {-0.5f, 0, 1, 0.5f, 0, 1, 0, 0.5f, 1};
  const auto found = fragments(view, kernels::project(view, corners), {0, 0, 64, 64});
  EXPECT_EQ(std::ranges::count_if(found, [](const Fragment& f) { return f.y == 32; }), 33);
  EXPECT_EQ(std::ranges::count_if(found, [](const Fragment& f) { return f.y < 32; }), 0);
}

}  // namespace fragments_test
}  // namespace tureen::trainer
