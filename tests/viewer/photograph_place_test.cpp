// A photograph covers the part of the image that its camera saw.
#include <gtest/gtest.h>

#include "viewer/comparison.hpp"

namespace tureen::viewer {
namespace photograph_place_test {

Camera off_center() {
  Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.8, 400, 300);
  camera.cx = 190.5;
  camera.cy = 160;
  camera.fx *= 1.01;
  return camera;
}

TEST(PhotographPlace, OfItsOwnCameraItFillsTheImage) {
  const Camera camera = off_center();
  const PlacedPhotograph placed = place(camera, camera, 1);
  EXPECT_NEAR(placed.low.x, 0, 1e-9);
  EXPECT_NEAR(placed.low.y, 0, 1e-9);
  EXPECT_NEAR(placed.high.x, 400, 1e-9);
  EXPECT_NEAR(placed.high.y, 300, 1e-9);
}

TEST(PhotographPlace, InAWiderImageItKeepsItsRays) {
  const Camera camera = off_center(), view = resized(camera, 1000, 600);
  const PlacedPhotograph placed = place(camera, view, 0.5);
  // The ray through any pixel is the same in both; these are the corners.
  EXPECT_NEAR((placed.low.x / 0.5 - view.cx) / view.fx, (0 - camera.cx) / camera.fx, 1e-12);
  EXPECT_NEAR((placed.high.y / 0.5 - view.cy) / view.fy, (300 - camera.cy) / camera.fy, 1e-12);
  EXPECT_NEAR(placed.high.y - placed.low.y, 300, 1e-9) << "the image's height, in points";
}

}  // namespace photograph_place_test
}  // namespace tureen::viewer
