#include "scene/camera.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

namespace tureen {
namespace camera_test {

glm::dvec2 pixel_of(const Camera& camera, glm::dvec3 world) {
  const glm::dvec4 clip =
      clip_from_view(camera, 0.1, 10.0) * camera.view_from_world * glm::dvec4(world, 1.0);
  // Image rows go down, NDC y goes up.
  return {(clip.x / clip.w + 1) * 0.5 * camera.width, (1 - clip.y / clip.w) * 0.5 * camera.height};
}

TEST(Camera, ProjectsByThePinholeEquationWithAnOffCenterPrincipalPoint) {
  Camera camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx = 500;
  camera.fy = 450;
  camera.cx = 300;
  camera.cy = 200;
  // A point 1 to the right, 0.5 up and 2 in front of the camera.
  const glm::dvec2 pixel = pixel_of(camera, {1.0, 0.5, -2.0});
  EXPECT_NEAR(pixel.x, 300 + 500 * 0.5, 1e-9);
  EXPECT_NEAR(pixel.y, 200 - 450 * 0.25, 1e-9);
}

/// By height, with the principal point as far from the middle as before; or by both sides.
TEST(Camera, ResizedAndResampledKeepTheirOffsets) {
  Camera camera = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 100, 50);
  camera.cx = 60;
  camera.cy = 20;
  const Camera wide = resized(camera, 300, 100);
  EXPECT_DOUBLE_EQ(wide.fx, 2 * camera.fx);
  EXPECT_DOUBLE_EQ(wide.fy, 2 * camera.fy);
  EXPECT_DOUBLE_EQ(wide.cx, 150 + 20);
  EXPECT_DOUBLE_EQ(wide.cy, 40);
  const Camera stretched = resampled(camera, 300, 100);
  EXPECT_DOUBLE_EQ(stretched.fx, 3 * camera.fx);
  EXPECT_DOUBLE_EQ(stretched.fy, 2 * camera.fy);
  EXPECT_DOUBLE_EQ(stretched.cx, 180);
  EXPECT_DOUBLE_EQ(stretched.cy, 40);
}

TEST(Camera, LookAtPutsTheTargetAtTheCenter) {
  const Camera camera = look_at({3, -2, 1}, {0.5, 0.25, 0}, {0, 0, 1}, 0.7, 800, 600);
  const glm::dvec2 pixel = pixel_of(camera, {0.5, 0.25, 0});
  EXPECT_NEAR(pixel.x, 400, 1e-9);
  EXPECT_NEAR(pixel.y, 300, 1e-9);
  EXPECT_NEAR(glm::length(camera.eye() - glm::dvec3(3, -2, 1)), 0, 1e-12);
}

TEST(Camera, LookAtSurvivesAnUpAxisAlongTheLineOfSight) {
  const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 0, 1}, 0.7, 100, 100);
  EXPECT_NEAR(glm::determinant(glm::dmat3(camera.view_from_world)), 1.0, 1e-12);
}

TEST(Camera, ReversedDepthIsOneAtTheNearPlaneAndZeroAtInfinity) {
  const Camera camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.7, 100, 100);
  const auto depth = [&](double z) {
    const glm::dvec4 clip = clip_from_view_reversed(camera, 0.25) * glm::dvec4(0, 0, -z, 1);
    return clip.z / clip.w;
  };
  EXPECT_DOUBLE_EQ(depth(0.25), 1.0);
  EXPECT_NEAR(depth(1e12), 0.0, 1e-12);
}

}  // namespace camera_test
}  // namespace tureen
