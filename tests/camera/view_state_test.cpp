// States of a view: a camera and back, and the states between two of them, as known values.
#include "camera/view_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "camera/camera_path.hpp"

namespace tureen {
namespace view_state_test {

constexpr double pi = 3.14159265358979323846;

ViewState some_state() {
  return {.up = glm::normalize(glm::dvec3(1, 2, 3)),
          .target = {0.5, -1, 2},
          .distance = 3,
          .bearing = {0.7, -0.4},
          .roll = 0.3,
          .lens = {.focal = 1.5, .aspect = 0.9, .offset = {0.1, -0.2}}};
}

TEST(ViewState, IsThatOfItsCamera) {
  const ViewState state = some_state();
  const Camera camera = camera_of(state, 640, 360);
  EXPECT_DOUBLE_EQ(camera.fy, 1.5 * 360);
  EXPECT_DOUBLE_EQ(camera.fx, 0.9 * 1.5 * 360);
  EXPECT_DOUBLE_EQ(camera.cx, 320 + 0.1 * 360);
  EXPECT_DOUBLE_EQ(camera.cy, 180 - 0.2 * 360);
  EXPECT_NEAR(glm::length(camera.eye() - state.target), 3, 1e-12);
  const ViewState back = state_of(camera, state.up, state.distance);
  EXPECT_NEAR(back.bearing.azimuth, 0.7, 1e-12);
  EXPECT_NEAR(back.bearing.elevation, -0.4, 1e-12);
  EXPECT_NEAR(back.roll, 0.3, 1e-12);
  EXPECT_NEAR(glm::length(back.target - state.target), 0, 1e-12);
  EXPECT_NEAR(back.lens.offset.x, 0.1, 1e-12);
  EXPECT_NEAR(back.lens.offset.y, -0.2, 1e-12);
}

TEST(ViewState, BetweenTwoHasTheMeanOfEachNumber) {
  const ViewState from = some_state();
  ViewState to = from;
  to.target = {2.5, 1, 0};
  to.distance = 12;
  to.bearing = {1.1, 0.2};
  to.roll = -0.1;
  to.lens = {.focal = 6, .aspect = 0.9 * 4, .offset = {-0.3, 0.2}};
  const ViewState half = between(from, to, 0.5, GlideAbout::target);
  EXPECT_NEAR(half.distance, 6, 1e-12);  // geometric means of lengths
  EXPECT_NEAR(half.lens.focal, 3, 1e-12);
  EXPECT_NEAR(half.lens.aspect, 1.8, 1e-12);
  EXPECT_NEAR(half.bearing.azimuth, 0.9, 1e-12);
  EXPECT_NEAR(half.bearing.elevation, -0.1, 1e-12);
  EXPECT_NEAR(half.roll, 0.1, 1e-12);
  EXPECT_NEAR(glm::length(half.lens.offset - glm::dvec2(-0.1, 0)), 0, 1e-12);
  EXPECT_NEAR(glm::length(half.target - glm::dvec3(1.5, 0, 1)), 0, 1e-12);
  const ViewState by_eye = between(from, to, 0.25, GlideAbout::eye);
  EXPECT_NEAR(glm::length(eye_of(by_eye) - (eye_of(from) + 0.25 * (eye_of(to) - eye_of(from)))), 0,
              1e-12);
  EXPECT_EQ(between(from, to, 1, GlideAbout::target).distance, 12);
}

TEST(ViewState, TakesTheShortWay) {
  ViewState state = some_state(), reference = state;
  reference.bearing.azimuth = 0.7 + 5 * pi;
  reference.roll = 0.3 - 2 * pi;
  take_short_way(state, reference);
  EXPECT_NEAR(std::abs(state.bearing.azimuth - reference.bearing.azimuth), pi, 1e-9);
  EXPECT_NEAR(state.roll, reference.roll, 1e-12);
}

TEST(CameraPaths, WithoutAKeyframeBeginAndEndAtZero) {
  const CameraPath path;
  EXPECT_TRUE(path.empty());
  EXPECT_EQ(path.begin(), 0);
  EXPECT_EQ(path.duration(), 0);
}

}  // namespace view_state_test
}  // namespace tureen
