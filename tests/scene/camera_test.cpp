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

TEST(Camera, ProjectsByThePinholeEquationWithAnOffCentrePrincipalPoint) {
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

TEST(Camera, LookAtPutsTheTargetAtTheCentre) {
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
