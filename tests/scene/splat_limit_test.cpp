#include "scene/edit/splat_limit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_remarks.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace splat_limit_test {

/// Gaussians in a row, with these products of opacity and area.
Splats row_of(const std::vector<float>& contributions) {
  Gaussians gaussians;
  for (std::size_t i = 0; i < contributions.size(); ++i) {
    gaussians.centers.emplace_back(float(i), 0.0f, 0.0f);
    gaussians.scales.emplace_back(2.0f, 0.5f, contributions[i]);  // the two largest: 2 and this
    gaussians.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
    gaussians.opacity.push_back(0.5f);
  }
  Splats splats{.kernel = gaussians, .profile = *profile_named("3dgs")};
  splats.color.coefficients.resize(contributions.size());
  return splats;
}

std::vector<float> places(const Splats& splats) {
  std::vector<float> result;
  for (std::size_t i = 0; i < count(splats); ++i) result.push_back(float(center(splats, i).x));
  return result;
}

TEST(SplatLimit, KeepsTheLargestInTheirOrder) {
  const Splats all = row_of({3, 1, 4, 1, 5, 9, 2, 6});
  EXPECT_EQ(places(largest_splats(all, 3)), (std::vector<float>{4, 5, 7}));
  EXPECT_EQ(places(largest_splats(all, 7)), (std::vector<float>{0, 1, 2, 4, 5, 6, 7}))
      << "of equal ones the first";
  EXPECT_EQ(count(largest_splats(all, 8)), 8u);
  EXPECT_THAT(splat_contributions(all.kernel), ::testing::ElementsAre(3, 1, 4, 1, 5, 9, 2, 6));
}

TEST(SplatLimit, SharesTheNumberAmongLayers) {
  Scene scene = scene_of(row_of({1, 2, 3, 4, 5, 6}));
  scene.layers.push_back({.primitives = row_of({7, 8, 9})});
  scene.layers.push_back({.primitives = TriangleSoup{}});
  limit_splats(scene, 9);
  EXPECT_TRUE(scene.info.remarks.empty());
  limit_splats(scene, 6);
  EXPECT_EQ(count(std::get<Splats>(scene.layers[0].primitives)), 4u);
  EXPECT_EQ(count(std::get<Splats>(scene.layers[1].primitives)), 2u);
  ASSERT_EQ(scene.info.remarks.size(), 1u);
  EXPECT_EQ(scene.info.remarks[0], (Remark{&remarks::splats_limited, {{"kept", 6}, {"all", 9}}}));
  limit_splats(scene, 1);
  EXPECT_EQ(count(std::get<Splats>(scene.layers[1].primitives)), 1u) << "a layer is never empty";
}

TEST(SplatLimit, IsReachedExactly) {
  for (const std::uint64_t all : {398u, 1000u, 4999999u})
    for (const std::uint64_t max : {1u, 245u, 397u}) {
      EXPECT_EQ(share_of(all, 0, max, all), max);
      const std::uint64_t first = all / 3;
      if (max > 1) {
        EXPECT_EQ(share_of(first, 0, max, all) + share_of(all - first, first, max, all), max);
      }
    }
}

TEST(SplatLimit, RanksExtremeValues) {
  Splats splats = row_of({1, 2, 3});
  auto& gaussians = std::get<Gaussians>(splats.kernel);
  gaussians.scales[0] = glm::vec3(3e38f);
  gaussians.opacity[0] = 0.0f;
  EXPECT_EQ(places(largest_splats(splats, 2)), (std::vector<float>{1, 2}));
  gaussians.opacity[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(places(largest_splats(splats, 2)), (std::vector<float>{1, 2}));
}

TEST(SplatLimit, FitsEveryKernel) {
  for (const test::SplatKind& kind : test::splat_kinds) {
    const Splats splats = largest_splats(test::random_splats(kind, 50, 0.1, 3), 20);
    EXPECT_EQ(count(splats), 20u) << kind.name;
    EXPECT_FALSE(defect(splats)) << kind.name;
  }
}

}  // namespace splat_limit_test
}  // namespace tureen
