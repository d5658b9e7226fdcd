// Captures: what recorded cameras look at, views around it, the first view, and paths along
// cameras.
#include "camera/capture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "camera/angles.hpp"
#include "camera/camera_path.hpp"
#include "camera/recorded_path.hpp"

namespace tureen {
namespace {

const glm::dvec3 up(0, 0, 1), center(3, -2, 1);

/// Cameras on a circle of radius 4 and height 1.5 about the centre, `turn` radians in all.
std::vector<Camera> ring(int count, double turn = full_turn) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double angle = turn * i / count;
    const glm::dvec3 eye = center + glm::dvec3(4 * std::cos(angle), 4 * std::sin(angle), 1.5);
    cameras.push_back(look_at(eye, center, up, 50 * degree, 600, 400));
    cameras.back().name = std::to_string(i);
  }
  return cameras;
}

LayerPlace box(const glm::vec3& low, const glm::vec3& high) {
  return {.bounds = {low, high}, .world_from_layer = glm::dmat4(1.0)};
}

TEST(Capture, IsWhatMostCamerasLookAt) {
  std::vector<Camera> cameras = ring(20);
  // Three cameras look elsewhere: they do not move the median.
  for (int i = 0; i < 3; ++i)
    cameras.push_back(look_at({40, 2.0 * i, 9}, {60, 50, 20}, up, 1, 600, 400));
  const auto capture = capture_of(cameras, 7.0 * up);
  ASSERT_TRUE(capture);
  // Least squares alone is 4 units away; the weights leave a part of the strays' pull, 20 rounds
  // would leave less.
  EXPECT_LT(glm::distance(capture->center, center), 0.05);
  EXPECT_NEAR(capture->distance, std::hypot(4, 1.5), 0.05);
  EXPECT_NEAR(capture->bearing.elevation, std::atan2(1.5, 4), 0.02);
  EXPECT_NEAR(capture->half_tangent, std::tan(25 * degree), 1e-12);
  EXPECT_TRUE(capture->is_all_around());
  EXPECT_FALSE(capture_of(ring(2), up));
  // Parallel lines of sight meet nowhere.
  std::vector<Camera> parallel;
  for (int i = 0; i < 9; ++i)
    parallel.push_back(look_at({double(i), 0, 0}, {double(i), 1, 0}, up, 1, 600, 400));
  EXPECT_FALSE(capture_of(parallel, up));
}

TEST(Capture, ViewsGoAroundPlacesAndFrameObjects) {
  const std::vector<Camera> all_around = ring(20), one_side = ring(20, 1.0);
  const std::vector<LayerPlace> object{box({2, -3, 0}, {4, -1, 2})},
      place{box({-20, -20, -3}, {20, 20, 6})};
  EXPECT_FALSE(capture_of(all_around, up, object));
  EXPECT_TRUE(capture_of(all_around, up, place));
  EXPECT_TRUE(capture_of(one_side, up, object));

  const auto capture = capture_of(one_side, up);
  ASSERT_TRUE(capture);
  const Lens lens = lens_of(*capture, 300, 600);
  // The smaller side shows what it shows in a photograph.
  EXPECT_NEAR(std::tan(0.5 * lens.fov_y) * 300 / 600, std::tan(25 * degree), 1e-12);
  const std::vector<Camera> views = orbit(*capture, 8, lens);
  for (const Camera& view : views) {
    EXPECT_NEAR(glm::distance(view.eye(), center), capture->distance, 1e-9);
    EXPECT_NEAR(view.eye().z - center.z, 1.5, 1e-9);
  }
  // From the second camera to the last but one: a twentieth is cut at each end.
  const auto angle_of = [](const Camera& view) {
    const glm::dvec3 direction = view.eye() - center;
    return std::atan2(direction.y, direction.x);
  };
  EXPECT_NEAR(angle_of(views[0]), 0.05, 1e-9);
  EXPECT_NEAR(angle_of(views[7]), 0.9, 1e-9);
  const CameraPath swing(turntable(*capture, lens, 4));
  EXPECT_TRUE(swing.is_loop());
  for (const auto& [seconds, angle] : {std::pair(0.0, 0.475), {1.0, 0.9}, {3.0, 0.05}})
    EXPECT_NEAR(angle_of(swing.at(seconds, 30, 60)), angle, 1e-6);
}

TEST(Capture, TheFirstViewIsStoredOrOneOfTheCameras) {
  const std::vector<Camera> cameras = ring(40, 1.0);
  const Camera stored = look_at({1, 1, 1}, {0, 0, 0}, up, 1, 64, 64);
  EXPECT_EQ(first_view_of(stored, cameras, up), stored);
  EXPECT_EQ(first_view_of({}, {}, up), std::nullopt);
  EXPECT_EQ(first_view_of({}, std::span(cameras).first(2), up), cameras[0]);
  const auto middle = first_view_of({}, cameras, up);
  ASSERT_TRUE(middle);
  EXPECT_TRUE(*middle == cameras[19] || *middle == cameras[20]) << middle->name;
}

TEST(RecordedPath, KeepsARecordedOrderAndFindsAShortOne) {
  std::vector<Camera> cameras = ring(30, 5.0);
  std::vector<std::size_t> recorded(30);
  for (std::size_t i = 0; i < 30; ++i) recorded[i] = i;
  EXPECT_EQ(order_along(cameras), recorded);

  std::mt19937 random(61);
  std::shuffle(cameras.begin(), cameras.end(), random);
  std::vector<int> found;
  for (const std::size_t i : order_along(cameras)) found.push_back(std::stoi(cameras[i].name));
  if (found.front() > found.back()) std::reverse(found.begin(), found.end());
  for (int i = 0; i < 30; ++i) EXPECT_EQ(found[std::size_t(i)], i);
}

TEST(RecordedPath, GoesNearTheCamerasWithoutJumps) {
  std::vector<Camera> cameras = ring(60);
  // Held by hand: 1 % of the distance, 1 degree.
  std::mt19937 random(62);
  std::normal_distribution<double> noise(0, 0.04);
  for (Camera& camera : cameras) {
    const glm::dvec3 eye = camera.eye() + glm::dvec3(noise(random), noise(random), noise(random));
    camera = look_at(eye, center + glm::dvec3(noise(random), noise(random), noise(random)), up,
                     50 * degree, 600, 400);
  }
  const CameraPath path(path_along(cameras, 10.0));
  EXPECT_TRUE(path.is_loop());
  EXPECT_DOUBLE_EQ(path.duration(), 10);
  const std::vector<Camera> views =
      frames(path, {.frames_per_second = 30, .width = 60, .height = 40});
  for (std::size_t i = 0; i < views.size(); ++i) {
    const glm::dvec3 eye = views[i].eye();
    // A mean over an interval, a twentieth of the circle, is 5 % nearer to the centre.
    EXPECT_NEAR(glm::length(glm::dvec2(eye - center)), 4, 0.3);
    // The circle's 25 units in 300 frames are 0.084 each; half more for noise and curves.
    EXPECT_LT(glm::distance(eye, views[(i + 1) % views.size()].eye()), 0.126) << i;
    EXPECT_GT(glm::dot(-views[i].world_from_view_rotation()[2], glm::normalize(center - eye)),
              std::cos(2 * degree));
    EXPECT_GT(views[i].world_from_view_rotation()[1].z, 0.9);
  }
  // Cameras of damaged files do not count.
  std::vector<Camera> damaged(3, cameras[0]);
  damaged[0].fy = 0;
  damaged[1].view_from_world[0] *= 1e300;
  damaged[2].view_from_world[3].x = 1e308;
  EXPECT_TRUE(path_along(damaged).keyframes.empty());
  // One camera, and cameras at one place, are a pause.
  for (const std::size_t count : {1u, 3u}) {
    const std::vector<Camera> still(count, cameras[0]);
    const CameraPath paused(path_along(still));
    EXPECT_LT(glm::distance(paused.at(1, 60, 40).eye(), cameras[0].eye()), 1e-9);
  }
}

}  // namespace
}  // namespace tureen
