// Effects of drags, wheel and keys on a view. The file exceeds 600 lines: random sequences of every
// control share one fixture and the same invariants, at scales from 1e-6 to 1e8.
#include "camera/camera_controls.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <vector>

#include "camera/camera_path.hpp"
#include "camera/capture.hpp"
#include "tests/support/random.hpp"

namespace tureen {
namespace camera_controls_test {

using test::Random;

constexpr double pi = 3.14159265358979323846;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int width = 1280, height = 720;

/// A world point in pixels from the top left corner, and its depth.
glm::dvec3 pixel_of(const Camera& camera, const glm::dvec3& world) {
  const glm::dvec3 v(camera.view_from_world * glm::dvec4(world, 1.0));
  return {camera.cx - camera.fx * v.x / v.z, camera.cy + camera.fy * v.y / v.z, -v.z};
}

double largest_difference(const Camera& a, const Camera& b) {
  double largest = 0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      largest = std::max(largest,
                         std::abs(a.view_from_world[column][row] - b.view_from_world[column][row]));
  return std::max({largest, std::abs(a.fx - b.fx), std::abs(a.fy - b.fy), std::abs(a.cx - b.cx),
                   std::abs(a.cy - b.cy)});
}

std::array<std::uint64_t, 16> bits_of(const glm::dmat4& matrix) {
  return std::bit_cast<std::array<std::uint64_t, 16>>(matrix);
}

bool same_bits(const Camera& a, const Camera& b) {
  return a.name == b.name && a.width == b.width && a.height == b.height && a.fx == b.fx &&
         a.fy == b.fy && a.cx == b.cx && a.cy == b.cy &&
         bits_of(a.view_from_world) == bits_of(b.view_from_world);
}

/// The largest entry of R^T R - 1, or the difference between the determinant and 1.
double orthonormality(const Camera& camera) {
  const glm::dmat3 r = camera.world_from_view_rotation();
  const glm::dmat3 defect = glm::transpose(r) * r - glm::dmat3(1.0);
  double largest = std::abs(glm::determinant(r) - 1);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) largest = std::max(largest, std::abs(defect[column][row]));
  return largest;
}

Camera shown(const CameraControls& controls) { return controls.camera(width, height); }

CameraControls stiff(const Subject& subject = {}) {
  CameraControls controls(subject);
  controls.set_viewport(width, height);
  controls.set_smoothing(0);
  return controls;
}

Subject random_subject(Random& random, double size) {
  const glm::dvec3 center = size * 3.0 * random.direction();
  const glm::dvec3 half =
      size * glm::dvec3(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
  return {center - half, center + half, random.direction()};
}

/// A camera like a recorded one, with any rotation and intrinsics.
Camera random_camera(Random& random, double size) {
  Camera camera = look_at(size * 4.0 * random.direction(), size * random.direction(),
                          random.direction(), random.uniform(0.2, 1.5), 960, 540);
  camera.name = "images/0001.jpg";
  camera.fx *= random.uniform(0.8, 1.2);
  camera.cx += random.uniform(-50, 50);
  camera.cy += random.uniform(-50, 50);
  return camera;
}

/// Applies one random action of a user.
void act(CameraControls& controls, Random& random) {
  const double dx = 200 * random.normal(), dy = 200 * random.normal();
  const double size = controls.radius();
  switch (random.below(16)) {
    case 0:
      return controls.orbit(dx, dy);
    case 1:
      return controls.look(dx, dy);
    case 2:
      return controls.pan(dx, dy);
    case 3:
      return controls.dolly(random.normal() * 3);
    case 4:
      return controls.dolly(random.normal(), {random.uniform(0, width), dy});
    case 5:
      return controls.scale_speed(random.normal());
    case 6:
      return controls.advance(random.uniform(0, 0.1), {random.direction(), random.uniform(0, 4)});
    case 7:
      return controls.advance(random.chance(0.5) ? 0.0 : 10.0);
    case 8:
      return controls.frame();
    case 9:
      return controls.look_from(named_views[random.below(named_views.size())]);
    case 10:
      return controls.set_up(random.direction());
    case 11:
      return controls.adopt(random_camera(random, size));
    case 12:
      return controls.set_fov(random.uniform(0.01, 2.5));
    case 13:
      return controls.set_mode(random.chance(0.5) ? NavigationMode::fly : NavigationMode::orbit);
    case 14:
      return controls.focus(controls.target() + 0.1 * size * random.direction());
    default:
      return random.chance(0.1) ? controls.reset() : controls.drag(dx, dy);
  }
}

TEST(CameraControls, BeginWithTheFramedThreeQuarterView) {
  for (const double size : {1e-6, 1.0, 1e8}) {
    const Subject subject{glm::dvec3(-size), {size, size, 3 * size}, {0, 0, 1}};
    const CameraControls controls = stiff(subject);
    const Camera expected = frame(subject, three_quarter_view, {width, height});
    const Camera actual = shown(controls);
    EXPECT_LT(glm::length(expected.eye() - actual.eye()), 1e-12 * size) << size;
    EXPECT_NEAR(actual.fy, expected.fy, 1e-9);
    for (int i = 0; i < 3; ++i)
      EXPECT_LT(glm::length(expected.world_from_view_rotation()[i] -
                            actual.world_from_view_rotation()[i]),
                1e-12);
  }
}

TEST(CameraControls, AnythingInAnyOrderKeepsARigidFiniteCamera) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const double size = std::pow(10.0, random.uniform(-6, 8));
    CameraControls controls(random_subject(random, size));
    controls.set_viewport(width, height);
    controls.set_smoothing(random.chance(0.5) ? 0.0 : 0.06);
    for (int i = 0; i < 300; ++i) {
      act(controls, random);
      const Camera camera = shown(controls);
      ASSERT_LT(orthonormality(camera), 1e-12) << i;
      ASSERT_TRUE(std::isfinite(glm::length(camera.eye()))) << i;
      ASSERT_GT(camera.fx, 0) << i;
      ASSERT_GT(controls.distance(), 0) << i;
    }
    // After any sequence, one key restores a named view.
    controls.look_from(NamedView::front);
    controls.advance(10);
    EXPECT_FALSE(controls.moving());
    const glm::dvec3 target = pixel_of(shown(controls), controls.target());
    EXPECT_NEAR(target.x, 0.5 * width, 1e-6);
    EXPECT_NEAR(target.y, 0.5 * height, 1e-6);
  }
}

TEST(CameraControls, OrbitKeepsTargetDistanceAndLevel) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const double size = std::pow(10.0, random.uniform(-6, 8));
    CameraControls controls = stiff(random_subject(random, size));
    const glm::dvec3 target = controls.target();
    const double distance = controls.distance();
    for (int i = 0; i < 50; ++i) {
      controls.orbit(300 * random.normal(), 300 * random.normal());
      const Camera camera = shown(controls);
      EXPECT_EQ(controls.target(), target);
      EXPECT_NEAR(glm::length(camera.eye() - target), distance, 1e-12 * size * 10);
      const glm::dmat3 axes = camera.world_from_view_rotation();
      EXPECT_NEAR(glm::dot(axes[0], controls.up()), 0, 1e-12) << "the horizon must be level";
      EXPECT_GT(glm::dot(axes[1], controls.up()), 1e-3) << "up must point up: no pole is reached";
    }
  }
}

TEST(CameraControls, TheSceneFollowsThePointerWhenOrbiting) {
  CameraControls controls = stiff();
  controls.look_from(NamedView::front);
  const glm::dvec3 near_point = controls.target() + 0.1 * (controls.eye() - controls.target());
  controls.orbit(10, 20);
  const glm::dvec3 pixel = pixel_of(shown(controls), near_point);
  EXPECT_GT(pixel.x, 0.5 * width);
  EXPECT_GT(pixel.y, 0.5 * height);
  // A drag over the image's height is half a turn.
  CameraControls half = stiff();
  half.look_from(NamedView::front);
  half.orbit(height, 0);
  EXPECT_LT(glm::length(half.eye() - half.target() + glm::dvec3(0, 0, half.distance())), 1e-9);
}

TEST(CameraControls, ElevationEndsShortOfThePolesAndLeavesTheTopViewAlone) {
  CameraControls controls = stiff();
  controls.orbit(0, 1e6);
  const auto elevation = [&] {
    return std::asin(glm::dot(shown(controls).world_from_view_rotation()[2], controls.up()));
  };
  EXPECT_NEAR(elevation(), 89.9 * pi / 180, 1e-9);
  controls.look_from(NamedView::top);
  EXPECT_NEAR(elevation(), 0.5 * pi, 1e-9);
  const Camera top = shown(controls);
  EXPECT_LT(glm::length(top.world_from_view_rotation()[0] - glm::dvec3(1, 0, 0)), 1e-12);
  controls.orbit(0, 5);  // no effect, and no jump back: this is the pole
  EXPECT_LT(largest_difference(top, shown(controls)), 1e-12);
  controls.orbit(0, -72);
  EXPECT_NEAR(elevation(), 0.5 * pi - 0.1 * pi, 1e-9);
}

TEST(CameraControls, PanFollowsThePointerExactly) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const double size = std::pow(10.0, random.uniform(-6, 8));
    CameraControls controls = stiff(random_subject(random, size));
    if (random.chance(0.5)) controls.adopt(random_camera(random, size));
    controls.set_up(random.direction());
    if (random.chance(0.5)) controls.adopt(random_camera(random, size));  // with a roll
    const Camera before = shown(controls);
    // A point at the target's depth, anywhere in the image.
    const double depth = controls.distance();
    const glm::dmat3 axes = before.world_from_view_rotation();
    const glm::dvec3 point = controls.target() + depth * (random.uniform(-0.4, 0.4) * axes[0] +
                                                          random.uniform(-0.4, 0.4) * axes[1]);
    const double dx = 100 * random.normal(), dy = 100 * random.normal();
    controls.pan(dx, dy);
    const glm::dvec3 from = pixel_of(before, point), to = pixel_of(shown(controls), point);
    // In units of the depth: pixels divided by the focal length.
    EXPECT_NEAR((to.x - from.x - dx) / before.fx, 0, 1e-9);
    EXPECT_NEAR((to.y - from.y - dy) / before.fy, 0, 1e-9);
    EXPECT_NEAR(to.z / depth, 1, 1e-9);
  }
}

TEST(CameraControls, DollyIsMultiplicativeAndKeepsWhatIsUnderThePointer) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const double size = std::pow(10.0, random.uniform(-6, 8));
    CameraControls controls = stiff(random_subject(random, size));
    if (random.chance(0.5)) controls.adopt(random_camera(random, size));
    const double distance = controls.distance();
    const glm::dvec3 target = controls.target();
    controls.dolly(2);
    EXPECT_NEAR(controls.distance() / distance, 0.81, 1e-12);
    EXPECT_LT(glm::length(controls.target() - target), 1e-12 * size * 10);

    const Camera before = shown(controls);
    const glm::dvec2 pointer(random.uniform(0, width), random.uniform(0, height));
    const double depth = controls.distance();
    const glm::dvec3 ray((pointer.x - before.cx) / before.fx, -(pointer.y - before.cy) / before.fy,
                         -1);
    const glm::dvec3 point = before.eye() + depth * (before.world_from_view_rotation() * ray);
    controls.dolly(3.5, pointer);
    const glm::dvec3 after = pixel_of(shown(controls), point);
    EXPECT_NEAR(after.x, pointer.x, 1e-6);
    EXPECT_NEAR(after.y, pointer.y, 1e-6);
    EXPECT_NEAR(after.z / depth, std::pow(0.9, 3.5), 1e-9);
  }
}

TEST(CameraControls, DollyEndsSomewhereAndComesBack) {
  CameraControls controls = stiff();
  controls.dolly(1e300);
  EXPECT_NEAR(controls.distance() / (1e-5 * controls.radius()), 1, 1e-12);
  controls.dolly(-1e300);
  EXPECT_NEAR(controls.distance() / (1e4 * controls.radius()), 1, 1e-12);
  controls.frame();
  EXPECT_LT(controls.distance(), 10 * controls.radius());
}

TEST(CameraControls, LookKeepsTheEyeAndTurnsAsTheHandDoes) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const double size = std::pow(10.0, random.uniform(-6, 8));
    CameraControls controls = stiff(random_subject(random, size));
    controls.set_mode(NavigationMode::fly);
    const glm::dvec3 eye = shown(controls).eye();
    const glm::dvec3 ahead = controls.target();
    controls.drag(10, 10);
    const glm::dvec3 pixel = pixel_of(shown(controls), ahead);
    EXPECT_LT(pixel.x, 0.5 * width) << "looking right moves the scene left";
    EXPECT_LT(pixel.y, 0.5 * height);
    for (int i = 0; i < 20; ++i) controls.look(100 * random.normal(), 100 * random.normal());
    EXPECT_LT(glm::length(shown(controls).eye() - eye), 1e-12 * size * 20);
  }
}

TEST(CameraControls, FlyingGoesWhereTheCameraLooks) {
  CameraControls controls = stiff({{-2, -2, -2}, {2, 2, 2}, {0, 0, 1}});
  controls.set_mode(NavigationMode::fly);
  const Camera before = shown(controls);
  EXPECT_NEAR(controls.speed(), 0.25 * glm::length(glm::dvec3(4)), 1e-12);
  controls.advance(0.5, {.direction = {0, 0, -1}, .factor = fast_factor});
  const glm::dvec3 way = shown(controls).eye() - before.eye();
  const glm::dvec3 forward = -before.world_from_view_rotation()[2];
  EXPECT_LT(glm::length(way - 0.5 * 4 * controls.speed() * forward), 1e-12);
  // Diagonals have the same speed.
  const glm::dvec3 eye = controls.eye();
  controls.advance(1, {.direction = {1, 1, 1}});
  EXPECT_NEAR(glm::length(controls.eye() - eye), controls.speed(), 1e-12);
  const double speed = controls.speed();
  controls.wheel(2, {});
  EXPECT_NEAR(controls.speed(), 1.44 * speed, 1e-12);
}

TEST(CameraControls, ChangingTheModeChangesNoImage) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    CameraControls controls(random_subject(random, 1));
    controls.set_viewport(width, height);
    for (int i = 0; i < 100; ++i) {
      act(controls, random);
      const Camera before = shown(controls);  // often during a glide
      controls.set_mode(controls.mode() == NavigationMode::fly ? NavigationMode::orbit
                                                               : NavigationMode::fly);
      EXPECT_EQ(largest_difference(before, shown(controls)), 0);
    }
  }
}

TEST(CameraControls, HalvesOfADragDoWhatTheWholeDoes) {
  using Act = std::function<void(CameraControls&, double)>;
  const Act acts[] = {
      [](CameraControls& c, double part) { c.orbit(130 * part, -40 * part); },
      [](CameraControls& c, double part) { c.look(130 * part, -40 * part); },
      [](CameraControls& c, double part) { c.pan(130 * part, -40 * part); },
      [](CameraControls& c, double part) { c.dolly(3 * part); },
      [](CameraControls& c, double part) {
        c.dolly(3 * part, {100, 200});
      },
  };
  Random random(7);
  for (const Act& act_of : acts)
    for (int i = 0; i < 20; ++i) {
      CameraControls whole = stiff();
      whole.adopt(random_camera(random, 1));  // with a roll that fades
      CameraControls halves = whole;
      act_of(whole, 1);
      act_of(halves, 0.5);
      act_of(halves, 0.5);
      EXPECT_LT(largest_difference(shown(whole), shown(halves)), 1e-9);
    }
}

TEST(CameraControls, HalvesOfATimeDoWhatTheWholeDoes) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    CameraControls whole(random_subject(random, 1));
    whole.set_viewport(width, height);
    if (random.chance(0.5)) whole.set_mode(NavigationMode::fly);
    if (random.chance(0.2)) whole.set_smoothing(0);
    whole.adopt(random_camera(random, 1));
    whole.advance(0.02);
    CameraControls parts = whole;
    for (int i = 0; i < 10; ++i) {
      const double dx = 100 * random.normal(), dy = 100 * random.normal();
      whole.drag(dx, dy);
      parts.drag(dx, dy);
      const double seconds = random.uniform(0, 0.2);
      Flight flight;
      if (random.chance(0.7)) flight = {random.direction(), random.uniform(0.1, 4)};
      whole.advance(seconds, flight);
      for (int part = 0; part < 4; ++part) parts.advance(seconds / 4, flight);
      // Rounding error in pixels: focal lengths are about 1,000.
      EXPECT_LT(largest_difference(shown(whole), shown(parts)), 1e-9) << i;
      EXPECT_EQ(whole.moving(), parts.moving());
    }
  }
}

TEST(CameraControls, GlidingIsExponentialAndArrives) {
  CameraControls controls;
  controls.set_viewport(width, height);
  EXPECT_FALSE(controls.moving());
  const Camera before = shown(controls);
  const glm::dvec3 from = before.eye();
  controls.pan(100, 0);
  EXPECT_TRUE(controls.moving());
  EXPECT_EQ(largest_difference(before, shown(controls)), 0) << "no time has passed";
  controls.advance(controls.smoothing());
  EXPECT_NEAR(
      glm::length(controls.eye() - shown(controls).eye()) / glm::length(controls.eye() - from),
      std::exp(-1.0), 1e-9);
  int frames = 0;
  for (; controls.moving() && frames < 1000; ++frames) controls.advance(1.0 / 60);
  EXPECT_LT(frames, 60) << "the window is idle after less than a second";
  EXPECT_EQ(shown(controls).eye(), camera_of({.up = controls.up(),
                                              .target = controls.target(),
                                              .distance = controls.distance(),
                                              .bearing = three_quarter_view},
                                             width, height)
                                       .eye());
}

TEST(CameraControls, APassingTimeOfNothingOrOfTenSeconds) {
  CameraControls controls;
  controls.set_viewport(width, height);
  controls.orbit(50, 50);
  const Camera before = shown(controls);
  controls.advance(0);
  controls.advance(-1);
  controls.advance(nan, {{0, 0, -1}});
  EXPECT_EQ(largest_difference(before, shown(controls)), 0);
  EXPECT_TRUE(controls.moving());
  controls.advance(10);
  EXPECT_FALSE(controls.moving());
}

TEST(CameraControls, WhatIsNotFiniteIsIgnored) {
  CameraControls controls = stiff();
  Random random(3);
  const Camera adopted = random_camera(random, 1);
  controls.adopt(adopted);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity}) {
    controls.orbit(bad, 1);
    controls.look(1, bad);
    controls.pan(bad, bad);
    controls.dolly(bad);
    controls.dolly(1, {bad, 0});
    controls.scale_speed(bad);
    controls.advance(bad);
    controls.advance(1, {{bad, 0, 0}});
    controls.advance(1, {{1, 0, 0}, bad});
    controls.set_up({bad, 0, 0});
    controls.set_fov(bad);
    controls.focus({bad, 0, 0});
    controls.set_target_depth(bad);
    controls.frame({bad, 0, 0}, {1, 1, 1});
    Camera broken = adopted;
    broken.view_from_world[3][0] = bad;
    controls.adopt(broken);
    broken = adopted;
    broken.fx = bad;
    controls.adopt(broken);
  }
  Camera flat = adopted;
  flat.view_from_world[0] = flat.view_from_world[1] = flat.view_from_world[2] = glm::dvec4(0);
  controls.adopt(flat);
  controls.set_viewport(0, 0);
  controls.advance(1, {{1, 0, 0}, -1});
  controls.set_up({0, 0, 0});
  EXPECT_TRUE(same_bits(controls.camera(adopted.width, adopted.height), adopted));
  EXPECT_TRUE(std::isfinite(controls.speed()));
}

TEST(CameraControls, BoxesThatAreNoneDoNotMatter) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Subject subjects[] = {{glm::dvec3(nan), glm::dvec3(nan)},
                              {glm::dvec3(infinity), glm::dvec3(-infinity)},
                              {glm::dvec3(5), glm::dvec3(5)},
                              {glm::dvec3(-1e308), glm::dvec3(1e308), {nan, 0, 0}}};
  for (const Subject& subject : subjects) {
    const Camera camera = shown(stiff(subject));
    EXPECT_LT(orthonormality(camera), 1e-12);
    EXPECT_TRUE(std::isfinite(glm::length(camera.eye())));
  }
  EXPECT_EQ(stiff(subjects[2]).target(), glm::dvec3(5));
}

TEST(CameraControls, AnAdoptedCameraIsThatVeryCameraUntilItMoves) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    CameraControls controls(random_subject(random, 1));
    controls.set_viewport(width, height);
    const Camera camera = random_camera(random, 1);
    controls.adopt(camera);
    controls.advance(5);
    ASSERT_TRUE(controls.shows_adopted());
    EXPECT_TRUE(same_bits(controls.camera(camera.width, camera.height), camera));
    EXPECT_LT(largest_difference(shown(controls), resized(camera, width, height)), 1e-12);
    controls.set_mode(NavigationMode::fly);
    controls.set_target_depth(2);
    controls.set_viewport(960, 540);
    EXPECT_TRUE(same_bits(controls.camera(camera.width, camera.height), camera));
    // A tiny movement makes a tiny change: pose, roll and intrinsics do not jump.
    controls.set_smoothing(0);
    controls.look(1e-7, 0);
    EXPECT_FALSE(controls.shows_adopted());
    EXPECT_LT(largest_difference(controls.camera(camera.width, camera.height), camera), 1e-6);
  }
}

TEST(CameraControls, CamerasThatLookAlongTheUpAxisAreAdopted) {
  for (const double side : {1.0, -1.0}) {
    const Camera camera = look_at({0, side * 5, 0}, {}, {0.6, 0, 0.8}, 0.7, width, height);
    CameraControls controls = stiff();
    controls.adopt(camera);
    controls.pan(1e-9, 0);  // other bits, the same view
    EXPECT_LT(largest_difference(shown(controls), camera), 1e-8);
    controls.orbit(0, side * -height * 0.25);  // an eighth of a turn away from the pole
    EXPECT_NEAR(controls.eye().y, side * 5 * std::sqrt(0.5), 1e-9);
  }
}

TEST(CameraControls, ARollFadesWithTheWayOfThePointer) {
  CameraControls controls = stiff();
  const double roll = 0.3;
  Camera camera = look_at({0, 0, 5}, {}, {std::sin(-roll), std::cos(roll), 0}, 0.7, width, height);
  controls.adopt(camera);
  const auto tilt = [&] {
    return std::asin(glm::dot(shown(controls).world_from_view_rotation()[0], controls.up()));
  };
  EXPECT_NEAR(tilt(), roll, 1e-12);
  controls.pan(100, 20);
  controls.dolly(2);
  EXPECT_NEAR(tilt(), roll, 1e-12);
  controls.orbit(CameraControls::roll_fade * height, 0);
  EXPECT_NEAR(tilt(), roll / std::exp(1.0), 1e-12);
  controls.frame();
  EXPECT_NEAR(tilt(), 0, 1e-12);
}

TEST(CameraControls, NamedViewsShowTheirSideAndAllOfTheBox) {
  const Subject subject{{-3, -2, -1}, {3, 2, 1}, {0, 0, 1}};
  CameraControls controls = stiff(subject);
  const std::pair<NamedView, glm::dvec3> sides[] = {
      {NamedView::front, {0, -1, 0}}, {NamedView::back, {0, 1, 0}},
      {NamedView::left, {-1, 0, 0}},  {NamedView::right, {1, 0, 0}},
      {NamedView::top, {0, 0, 1}},    {NamedView::bottom, {0, 0, -1}}};
  for (const auto& [view, side] : sides) {
    controls.look_from(view);
    EXPECT_LT(glm::length(shown(controls).world_from_view_rotation()[2] - side), 1e-12)
        << name_of(view);
  }
  for (const NamedView view : named_views) {
    controls.look_from(view);
    const Camera camera = shown(controls);
    double largest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p(corner & 1 ? -3 : 3, corner & 2 ? -2 : 2, corner & 4 ? -1 : 1);
      const glm::dvec3 pixel = pixel_of(camera, p);
      largest = std::max(
          {largest, std::abs(pixel.x / (0.5 * width) - 1), std::abs(pixel.y / (0.5 * height) - 1)});
    }
    EXPECT_NEAR(largest, 1 / 1.05, 1e-9) << name_of(view);
    EXPECT_STRNE(name_of(view), "");
  }
}

TEST(CameraControls, ViewsAreReachedTheShortWay) {
  CameraControls controls;
  controls.look_from(NamedView::back);
  controls.arrive();
  controls.look_from(NamedView::left);  // from 180 to -90 degrees: through -180, not through 0
  double nearest_front = 4;
  while (controls.moving()) {
    controls.advance(0.005);
    const glm::dvec3 backward = shown(controls).world_from_view_rotation()[2];
    nearest_front = std::min(nearest_front, std::acos(glm::dot(backward, glm::dvec3(0, 0, 1))));
  }
  EXPECT_GT(nearest_front, 0.5 * pi - 1e-6);
}

TEST(CameraControls, AnotherUpAxisSetsTheSceneUpright) {
  CameraControls controls;
  controls.set_viewport(width, height);
  const Camera before = shown(controls);
  controls.set_up({0, 0, 2});
  EXPECT_LT(largest_difference(before, shown(controls)), 1e-9) << "the view does not jump";
  controls.advance(5);
  const Camera after = shown(controls);
  EXPECT_NEAR(glm::dot(after.world_from_view_rotation()[0], glm::dvec3(0, 0, 1)), 0, 1e-12);
  EXPECT_GT(after.world_from_view_rotation()[1].z, 0.5);
  EXPECT_NEAR(controls.distance(), glm::length(before.eye() - controls.target()), 1e-9);
  // The new front, from the same bearing.
  EXPECT_LT(glm::length(after.world_from_view_rotation()[2] -
                        direction_of({0, 0, 1}, three_quarter_view)),
            1e-12);
}

TEST(CameraControls, ResetShowsTheFirstView) {
  Random random(5);
  CameraControls controls = stiff();
  const Camera home = shown(controls);
  for (int i = 0; i < 10; ++i) controls.orbit(100, 30);
  controls.set_fov(1.5);
  controls.reset();
  EXPECT_LT(largest_difference(home, shown(controls)), 1e-9);
  const Camera first = random_camera(random, 1);
  controls.set_first_view(first);
  controls.reset();
  EXPECT_TRUE(same_bits(controls.camera(first.width, first.height), first));
  controls.home();
  EXPECT_LT(largest_difference(home, shown(controls)), 1e-9);
}

TEST(CameraControls, TheFirstViewShowsTheWholeRecordedImage) {
  Random random(8);
  const Camera first = random_camera(random, 1);
  const auto corners_are_inside = [&](const Camera& view) {
    for (const double x : {0, first.width})
      for (const double y : {0, first.height}) {
        const glm::dvec4 corner((x - first.cx) / first.fx, -(y - first.cy) / first.fy, -1, 1);
        const glm::dvec3 pixel =
            pixel_of(view, glm::dvec3(glm::inverse(first.view_from_world) * corner));
        EXPECT_GE(std::min(pixel.x, pixel.y), -1e-9);
        EXPECT_LE(pixel.x, view.width + 1e-9);
        EXPECT_LE(pixel.y, view.height + 1e-9);
      }
  };
  CameraControls controls = stiff();
  controls.set_first_view(first);
  controls.reset();
  EXPECT_EQ(shown(controls), resized(first, width, height)) << "at least as wide as the image";
  controls.set_viewport(390, 844);  // a phone that is turned
  EXPECT_TRUE(controls.goes_to_first_view());
  const Camera upright = controls.camera(390, 844);
  corners_are_inside(upright);
  EXPECT_NEAR(upright.fx, first.fx * 390 / first.width, 1) << "not smaller than necessary";
  controls.set_viewport(width, height);
  EXPECT_EQ(shown(controls), resized(first, width, height));
  controls.set_viewport(390, 844);
  controls.orbit(10, 0);
  EXPECT_FALSE(controls.goes_to_first_view());
  const double fov = controls.fov();
  controls.set_viewport(width, height);
  EXPECT_EQ(controls.fov(), fov) << "a moved view is kept";
  controls.adopt(first);
  controls.set_viewport(390, 844);
  EXPECT_EQ(controls.camera(390, 844), resized(first, 390, 844)) << "as is any other camera";
}

/// `tureen render` draws the right side (cli/options/view_options.cpp).
TEST(CameraControls, TheFirstViewIsThatOfOtherProgramsAtAnySize) {
  Random random(9);
  const Camera first = random_camera(random, 1);
  CameraControls controls = stiff();
  controls.set_first_view(first);
  for (const glm::ivec2 size :
       std::vector<glm::ivec2>{{1600, 500}, {500, 500}, {390, 844}, {7, 900}}) {
    controls.set_viewport(size.x, size.y);
    controls.reset();
    EXPECT_EQ(controls.camera(size.x, size.y), resized(whole_in(size, first), size.x, size.y))
        << size.x;
  }
}

TEST(CameraControls, ResetRestoresTheUpAxis) {
  Random random(6);
  Subject subject = random_subject(random, 1);
  CameraControls controls = stiff(subject);
  const Camera home = shown(controls);
  const glm::dvec3 up = controls.up();
  controls.set_up(-up);
  controls.reset();
  EXPECT_EQ(controls.up(), up);
  EXPECT_LT(largest_difference(home, shown(controls)), 1e-9);
  // Also after a recorded camera, and of a subject that followed.
  const Camera first = random_camera(random, 1);
  controls.set_first_view(first);
  subject.up = {0, 0, 3};
  controls.set_subject(subject);
  EXPECT_EQ(controls.up(), up);
  controls.set_up({1, 0, 0});
  controls.reset();
  EXPECT_EQ(controls.up(), glm::dvec3(0, 0, 1));
  EXPECT_TRUE(same_bits(controls.camera(first.width, first.height), first));
}

TEST(CameraControls, KeyframesOfAnOrbitMakeAPathAroundItsTarget) {
  CameraControls controls = stiff();
  CameraPathData data;
  for (int i = 0; i < 4; ++i) {
    data.keyframes.push_back(controls.keyframe(width, height, i));
    controls.orbit(200, 10);
  }
  const CameraPath path(data);
  for (double t = 0; t < 3; t += 0.1)
    EXPECT_NEAR(glm::length(path.at(t, width, height).eye() - controls.target()),
                controls.distance(), 1e-9);
}

TEST(CameraControls, FocusBringsAPointToTheCenterAsLargeAsItWas) {
  CameraControls controls = stiff();
  const glm::dvec3 point = controls.target() + glm::dvec3(0.2, 0.1, -0.3);
  const double depth = pixel_of(shown(controls), point).z;
  controls.focus(point);
  const glm::dvec3 pixel = pixel_of(shown(controls), point);
  EXPECT_NEAR(pixel.x, 0.5 * width, 1e-9);
  EXPECT_NEAR(pixel.y, 0.5 * height, 1e-9);
  EXPECT_NEAR(pixel.z, depth, 1e-12);
  const Camera before = shown(controls);
  controls.focus(controls.eye() + (controls.eye() - point));
  EXPECT_EQ(largest_difference(before, shown(controls)), 0) << "behind the eye";
}

TEST(CameraControls, TheAngleOfViewHasLimitsAndKeepsTheEye) {
  CameraControls controls = stiff();
  const glm::dvec3 eye = controls.eye();
  for (const double fov : {1e-9, 0.3, 1.0, 4.0}) {
    controls.set_fov(fov);
    EXPECT_EQ(controls.eye(), eye);
    EXPECT_NEAR(controls.fov(), std::clamp(fov, 0.1 * pi / 180, 170 * pi / 180), 1e-12);
    EXPECT_NEAR(shown(controls).fy, 0.5 * height / std::tan(0.5 * controls.fov()), 1e-6);
  }
}

TEST(CameraControls, HundredsOfTurnsLoseNothing) {
  CameraControls controls = stiff();
  const Camera before = shown(controls);
  for (int i = 0; i < 4000; ++i) controls.orbit(height, 0);  // 2,000 turns
  // Rounding: 4,000 half turns, each with an error of at most 1e-13, for angles up to a hundred
  // turns.
  EXPECT_LT(largest_difference(before, shown(controls)), 1e-8);
}

TEST(CameraControls, NothingLeavesForeverInOneDirection) {
  CameraControls controls = stiff();
  for (int i = 0; i < 2000; ++i) {
    controls.pan(1e9, 0);
    controls.advance(10, {{0, 0, -1}, 1e6});
  }
  EXPECT_LE(glm::length(controls.target()), 1.1e5 * controls.radius());
  controls.frame();
  EXPECT_EQ(controls.target(), glm::dvec3(0));
}

}  // namespace camera_controls_test
}  // namespace tureen
