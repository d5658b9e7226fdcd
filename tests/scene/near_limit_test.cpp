// Near limits that hide splats are found, reported and changed.
#include "scene/near_limit.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "scene/lint/lint.hpp"
#include "scene/scene_remarks.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace near_limit_test {

/// Gaussians within about `radius` units around the origin, with the published near limit.
Scene scene_of_size(float radius) {
  Splats splats = test::random_splats(test::splat_kinds[1], 300, 0.01, 1);
  auto& gaussians = std::get<Gaussians>(splats.kernel);
  const Bounds box = bounds(splats);
  for (glm::vec3& center : gaussians.centers)
    center = (center - 0.5f * (box.low + box.high)) * (radius / float(box.radius()));
  splats.profile = *profile_named("3dgs");
  return scene_of(std::move(splats));
}

const RemarkKind* kind_of(const std::optional<Remark>& remark) {
  return remark ? remark->kind : nullptr;
}

bool is_linted(const Scene& scene) {
  return lint(std::get<Splats>(scene.layers[0].primitives))
             .find(LintFinding::Id::large_near_limit) != nullptr;
}

TEST(NearLimit, OfASceneInSmallUnitsIsReported) {
  Scene small = scene_of_size(0.1f), usual = scene_of_size(1);
  EXPECT_EQ(kind_of(near_limit_remark(small)), &remarks::near_limit_large);
  EXPECT_TRUE(is_linted(small));
  EXPECT_EQ(near_limit_remark(usual), std::nullopt);
  EXPECT_FALSE(is_linted(usual));
  // The limit scales with the layer.
  small.layers[0].world_from_layer = glm::dmat4(100);
  small.layers[0].world_from_layer[3][3] = 1;
  EXPECT_EQ(kind_of(near_limit_remark(small)), &remarks::near_limit_large);
  small.layers[0].visible = false;
  EXPECT_EQ(near_limit_remark(small), std::nullopt);
}

TEST(NearLimit, IsJudgedByTheFirstCamera) {
  Scene scene = scene_of_size(1);
  scene.cameras.push_back(look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.8, 64, 48));
  EXPECT_EQ(near_limit_remark(scene), std::nullopt);
  auto& splats = std::get<Splats>(scene.layers[0].primitives);
  splats.profile.min_center_depth = 4;  // hides the nearer half
  const std::optional<Remark> remark = near_limit_remark(scene);
  ASSERT_EQ(kind_of(remark), &remarks::near_limit_hides);
  const HiddenSplats view = hidden_by_near_limit(splats, glm::dmat4(1), scene.cameras[0]);
  EXPECT_EQ(view.in_view, 300u);
  EXPECT_GT(view.hidden, 90u);
  EXPECT_LT(view.hidden, 210u);
  // A small scene far from a camera loses nothing.
  Scene far = scene_of_size(0.1f);
  far.cameras = {look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.8, 64, 48)};
  EXPECT_EQ(near_limit_remark(far), std::nullopt);
}

TEST(NearLimit, OfTheUserIsInWorldUnits) {
  Scene scene = scene_of_size(0.1f);
  scene.layers[0].world_from_layer = glm::dmat4(2);
  scene.layers[0].world_from_layer[3][3] = 1;
  scene.info.remarks.push_back(*near_limit_remark(scene));
  choose_near_limit(scene, 0.01);
  EXPECT_FLOAT_EQ(std::get<Splats>(scene.layers[0].primitives).profile.min_center_depth, 0.005f);
  EXPECT_TRUE(scene.info.remarks.empty());
  EXPECT_EQ(near_limit_remark(scene), std::nullopt);
  Scene soup = scene_of(TriangleSoup{});
  EXPECT_THROW(choose_near_limit(soup, 0.01), UsageError);
}

TEST(NearLimit, OfAChosenProfileIsReported) {
  Scene scene = scene_of_size(0.1f);
  choose_near_limit(scene, 0.01);
  choose_profile(scene, "mip");
  ASSERT_EQ(scene.info.remarks.size(), 1u);
  EXPECT_EQ(scene.info.remarks[0].kind, &remarks::near_limit_large);
}

}  // namespace near_limit_test
}  // namespace tureen
