#include "jobs/visibility/splat_stats.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <initializer_list>
#include <utility>

#include "camera/survey_views.hpp"

namespace tureen {
namespace splat_stats_test {

/// Balls along the view of front_view(), of the largest opacity that is drawn.
Splats row_of_balls(std::initializer_list<std::pair<float, float>> depths_and_scales) {
  Gaussians balls;
  for (const auto& [depth, scale] : depths_and_scales) {
    balls.centers.emplace_back(0, 0, -depth);
    balls.scales.emplace_back(scale);
    balls.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
    balls.opacity.push_back(1);
  }
  Splats splats{.kernel = std::move(balls), .profile = *profile_named("3dgs")};
  splats.color.degree = 1;
  splats.color.coefficients.resize(4 * depths_and_scales.size(), glm::vec3(0.1f));
  return splats;
}

Camera front_view(const char* name, double focal) {
  Camera camera;
  camera.name = name;
  camera.width = camera.height = 64;
  camera.fx = camera.fy = focal;
  camera.cx = camera.cy = 32;
  camera.view_from_world = glm::dmat4(1);
  return camera;
}

TEST(SplatStats, CountTheSplatsThatNoViewShows) {
  // Each of the three large balls lets a hundredth through in the middle, so the small one behind
  // them is below the 10^-4 at which 3DGS stops.
  const Splats splats = row_of_balls({{2, 2}, {3, 3}, {4, 4}, {5, 0.002f}});
  const Camera views[] = {front_view("near", 40), front_view("far", 10)};
  const SplatStats stats = splat_stats(splats, glm::dmat4(1), views);
  EXPECT_EQ(stats.views, 2u);
  EXPECT_EQ(stats.never_drawn, 1u);
  EXPECT_GT(stats.mean_overdraw, 1);
  EXPECT_GE(stats.worst_overdraw, stats.mean_overdraw);
  EXPECT_LE(stats.worst_overdraw, 3);
  EXPECT_TRUE(stats.worst_view == "near" || stats.worst_view == "far");
  EXPECT_EQ(splat_stats(row_of_balls({{2, 0.5f}, {5, 0.002f}}), glm::dmat4(1), views).never_drawn,
            0u);
}

TEST(SplatStats, OfOneSplatHaveAnOverdrawOfOne) {
  const Camera views[] = {front_view("", 40)};
  const SplatStats stats = splat_stats(row_of_balls({{2, 0.2f}}), glm::dmat4(1), views);
  EXPECT_EQ(stats.mean_overdraw, 1);
  EXPECT_EQ(stats.worst_overdraw, 1);
  EXPECT_EQ(stats.never_drawn, 0u);
  Camera away = front_view("", 40);
  away.view_from_world[0][0] = away.view_from_world[2][2] = -1;
  const SplatStats none = splat_stats(row_of_balls({{2, 0.2f}}), glm::dmat4(1), {&away, 1});
  EXPECT_EQ(none.mean_overdraw, 0);
  EXPECT_EQ(none.never_drawn, 1u);
}

TEST(SplatStats, HaveTheBytesOfAllColumns) {
  const Splats splats = row_of_balls({{2, 0.5f}, {3, 0.75f}});
  std::size_t bytes = 0;
  for (const ColumnBytes& column : splat_stats(splats, glm::dmat4(1), {}).columns)
    bytes += column.bytes;
  EXPECT_EQ(bytes, byte_size(splats));
}

TEST(SurveyViews, AreRecordedOnesAndOthersAround) {
  Scene scene = scene_of(row_of_balls({{2, 0.5f}, {3, 0.75f}}));
  EXPECT_EQ(survey_views(scene, 16, 100).size(), 16u);
  for (int i = 0; i < 30; ++i) scene.cameras.push_back(front_view(i == 0 ? "first" : "", 640));
  scene.cameras[0].width = 640;
  const std::vector<Camera> views = survey_views(scene, 16, 320);
  EXPECT_EQ(views.size(), 16u);
  EXPECT_EQ(views[0].name, "first");
  EXPECT_EQ(views[0].width, 320);
  EXPECT_EQ(views[7].width, 64);
  EXPECT_EQ(views[8].width, 320);
  const auto distance = [](const Camera& camera) {
    return glm::length(camera.eye() - glm::dvec3(0, 0, -2.5));
  };
  EXPECT_LT(distance(views[9]), 0.5 * distance(views[8]));
}

}  // namespace splat_stats_test
}  // namespace tureen
