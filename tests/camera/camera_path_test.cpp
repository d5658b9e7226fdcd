#include "camera/camera_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "camera/camera_spline.hpp"
#include "tests/support/random.hpp"

namespace tureen {
namespace camera_path_test {

using test::Random;

constexpr double pi = 3.14159265358979323846;
constexpr int width = 640, height = 360;

double largest_difference(const Camera& a, const Camera& b) {
  double largest = 0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      largest = std::max(largest,
                         std::abs(a.view_from_world[column][row] - b.view_from_world[column][row]));
  return std::max({largest, std::abs(a.fx - b.fx) / b.fx, std::abs(a.fy - b.fy) / b.fy,
                   std::abs(a.cx - b.cx) / b.width, std::abs(a.cy - b.cy) / b.height});
}

CameraKeyframe random_keyframe(Random& random, double seconds, bool with_target) {
  const glm::dvec3 eye = 4.0 * random.direction(), target = random.direction();
  CameraKeyframe keyframe;
  keyframe.camera = look_at(eye, target, random.direction(), random.uniform(0.2, 1.5), 960, 540);
  keyframe.camera.fx *= random.uniform(0.8, 1.2);
  keyframe.camera.cx += random.uniform(-50, 50);
  keyframe.camera.cy += random.uniform(-50, 50);
  keyframe.seconds = seconds;
  if (with_target) keyframe.target_distance = glm::length(eye - target);
  return keyframe;
}

/// 2 to 9 keyframes at uneven times.
CameraPathData random_path(Random& random) {
  CameraPathData path;
  const bool with_targets = random.chance(0.5);
  double seconds = random.uniform(0, 3);
  for (int i = 2 + int(random.below(8)); i > 0; --i) {
    path.keyframes.push_back(random_keyframe(random, seconds, with_targets));
    seconds += random.uniform(0.2, 3);
  }
  if (random.chance(0.5)) path.loop_seconds = seconds - path.keyframes[0].seconds;
  return path;
}

/// All numbers of a camera in one list, for differences.
std::vector<double> numbers(const Camera& camera) {
  std::vector<double> result{camera.fx / height, camera.fy / height, camera.cx / height,
                             camera.cy / height};
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const glm::dvec3 eye = camera.eye();
  for (int i = 0; i < 3; ++i) {
    result.push_back(eye[i]);
    for (int j = 0; j < 3; ++j) result.push_back(axes[i][j]);
  }
  return result;
}

TEST(CameraPath, PassesThroughItsKeyframes) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const CameraPath path(random_path(random));
    for (const CameraKeyframe& keyframe : path.data().keyframes) {
      // Conversion to quaternions and logarithms and back: a few roundings of numbers below 10.
      EXPECT_LT(largest_difference(path.at(keyframe.seconds, 960, 540), keyframe.camera), 1e-13);
      EXPECT_LT(largest_difference(path.at(keyframe.seconds, width, height),
                                   resized(keyframe.camera, width, height)),
                1e-13);
    }
  }
}

TEST(CameraPath, IsSmoothAtItsKeyframes) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const CameraPath path(random_path(random));
    const std::size_t last = path.data().keyframes.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      if (!path.is_loop() && (i == 0 || i == last)) continue;
      const double t = path.data().keyframes[i].seconds;
      // One-sided differences of second order: their error is h^2 / 3 times the third derivative.
      // That is below 1e3 here: changes of 10 in spans of 0.2 s give 12 * 10 / 0.2^3, rarely more.
      constexpr double h = 1e-4;
      const auto slope = [&](double step) {
        const auto a = numbers(path.at(t, width, height));
        const auto b = numbers(path.at(t + step, width, height));
        const auto c = numbers(path.at(t + 2 * step, width, height));
        std::vector<double> result(a.size());
        for (std::size_t k = 0; k < a.size(); ++k)
          result[k] = (-3 * a[k] + 4 * b[k] - c[k]) / (2 * step);
        return result;
      };
      const auto left = slope(-h), right = slope(h);
      for (std::size_t k = 0; k < left.size(); ++k)
        EXPECT_NEAR(left[k], right[k], 1e-3) << "keyframe " << i << ", number " << k;
    }
  }
}

TEST(CameraPath, IsRigidAndFiniteEverywhereAtAnySize) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    CameraPathData data = random_path(random);
    const double size = std::pow(10.0, random.uniform(-6, 8));
    for (CameraKeyframe& keyframe : data.keyframes) {
      for (int i = 0; i < 3; ++i) keyframe.camera.view_from_world[3][i] *= size;
      keyframe.target_distance *= size;
      if (random.chance(0.2)) keyframe.seconds = data.keyframes.front().seconds;
      if (random.chance(0.2)) keyframe.camera = data.keyframes.front().camera;
    }
    const CameraPath path(data);
    for (int i = 0; i < 200; ++i) {
      const Camera camera = path.at(random.uniform(-30, 30), width, height);
      const glm::dmat3 axes = camera.world_from_view_rotation();
      const glm::dmat3 defect = glm::transpose(axes) * axes - glm::dmat3(1.0);
      for (int k = 0; k < 9; ++k) ASSERT_NEAR(defect[k / 3][k % 3], 0, 1e-12);
      ASSERT_LT(glm::length(camera.eye()), 100 * size);
      ASSERT_GT(camera.fx, 0);
      ASSERT_TRUE(std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy));
    }
  }
}

TEST(CameraPath, ALoopMeetsItsBeginning) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    CameraPathData data = random_path(random);
    data.loop_seconds = data.keyframes.back().seconds - data.keyframes.front().seconds + 1.5;
    const CameraPath path(data);
    EXPECT_DOUBLE_EQ(path.duration(), data.loop_seconds);
    for (int i = 0; i < 20; ++i) {
      const double t = random.uniform(-5, 5);
      EXPECT_LT(largest_difference(path.at(t, width, height),
                                   path.at(t + path.duration(), width, height)),
                1e-9);
    }
    const double seam = path.begin() + path.duration();
    EXPECT_LT(largest_difference(path.at(seam - 1e-9, width, height),
                                 path.at(path.begin(), width, height)),
              1e-6);
  }
}

TEST(CameraPath, APathThatEndsStandsStillBeforeAndAfter) {
  Random random(3);
  CameraPathData data = random_path(random);
  data.loop_seconds = 0;
  const CameraPath path(data);
  const double infinity = std::numeric_limits<double>::infinity();
  const Camera first = path.at(path.begin(), width, height);
  const Camera last = path.at(path.begin() + path.duration(), width, height);
  EXPECT_LT(largest_difference(last, resized(data.keyframes.back().camera, width, height)), 1e-13);
  for (const double t : {-infinity, -10.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(largest_difference(path.at(t, width, height), first), 0);
  for (const double t : {infinity, 1e9})
    EXPECT_EQ(largest_difference(path.at(t, width, height), last), 0);
}

TEST(CameraPath, OneKeyframeStays) {
  Random random(4);
  for (const double loop : {0.0, 5.0}) {
    CameraPathData data{.keyframes = {random_keyframe(random, 2, false)}, .loop_seconds = loop};
    const CameraPath path(data);
    EXPECT_EQ(path.duration(), loop);
    for (const double t : {0.0, 2.0, 4.9})
      EXPECT_LT(largest_difference(path.at(t, 960, 540), data.keyframes[0].camera), 1e-13);
  }
  EXPECT_TRUE(CameraPath().empty());
  EXPECT_EQ(CameraPath().duration(), 0);
}

TEST(CameraPath, TwoKeyframesAreAnEvenWay) {
  CameraPathData data;
  data.keyframes = {{look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.5, width, height), 0},
                    {look_at({2, 0, 4}, {2, 0, 0}, {0, 1, 0}, 1.0, width, height), 4}};
  const CameraPath path(data);
  for (const double t : {0.5, 1.0, 3.0}) {
    const Camera camera = path.at(t, width, height);
    EXPECT_NEAR(camera.eye().x, t / 2, 1e-12);
    // The focal length changes by equal factors in equal times.
    const double f0 = data.keyframes[0].camera.fy, f1 = data.keyframes[1].camera.fy;
    EXPECT_NEAR(camera.fy, f0 * std::pow(f1 / f0, t / 4), 1e-9);
  }
}

TEST(CameraPath, KeyframesAroundATargetTurnAboutIt) {
  CameraPathData data;
  const auto keyframe = [](double angle, double distance, double seconds) {
    return CameraKeyframe{
        look_at({1 + distance * std::sin(angle), 2, 3 + distance * std::cos(angle)}, {1, 2, 3},
                {0, 1, 0}, 0.7, width, height),
        seconds, distance};
  };
  data.keyframes = {keyframe(0, 5, 0), keyframe(2.5, 5, 2), keyframe(1, 5, 3)};
  const CameraPath path(data);
  for (double t = 0; t <= 3; t += 0.01) {
    const Camera camera = path.at(t, width, height);
    EXPECT_NEAR(glm::length(camera.eye() - glm::dvec3(1, 2, 3)), 5, 1e-12);
    EXPECT_NEAR(camera.eye().y, 2, 1e-12);
  }
  // Without the target distance, the eye takes a straighter way, inside the circle.
  for (CameraKeyframe& k : data.keyframes) k.target_distance = 0;
  const glm::dvec3 middle = CameraPath(data).at(1, width, height).eye();
  EXPECT_LT(glm::length(middle - glm::dvec3(1, 2, 3)), 4);
}

TEST(CameraPath, RotatesTheShortWayWithoutFlips) {
  CameraPathData data;
  for (int i = 0; i < 12; ++i) {
    const double angle = (i % 2 ? -10 : 10) * pi / 180;  // around 180 degrees: 170 and 190
    data.keyframes.push_back({look_at({0, 0, 0}, {std::sin(pi + angle), 0, std::cos(pi + angle)},
                                      {0, 1, 0}, 0.7, width, height),
                              double(i)});
  }
  const CameraPath path(data);
  for (double t = 0; t <= 11; t += 0.01) {
    const glm::dvec3 forward = -path.at(t, width, height).world_from_view_rotation()[2];
    EXPECT_LT(forward.z, std::cos(pi - 11 * pi / 180)) << t;
  }
}

TEST(CameraPath, APauseIsAPause) {
  Random random(8);
  CameraPathData data;
  for (int i = 0; i < 5; ++i) data.keyframes.push_back(random_keyframe(random, i, true));
  data.keyframes[3].camera = data.keyframes[2].camera;
  data.keyframes[3].target_distance = data.keyframes[2].target_distance;
  const CameraPath path(data);
  for (double t = 2; t <= 3; t += 0.05)
    EXPECT_LT(largest_difference(path.at(t, 960, 540), data.keyframes[2].camera), 1e-13) << t;
}

TEST(CameraPath, KeyframesOfOneTimeAreACut) {
  Random random(9);
  CameraPathData data;
  for (const double t : {0.0, 1.0, 2.0, 2.0, 3.0, 4.0})
    data.keyframes.push_back(random_keyframe(random, t, false));
  const CameraPath path(data);
  EXPECT_LT(largest_difference(path.at(2, 960, 540), data.keyframes[3].camera), 1e-13);
  EXPECT_LT(largest_difference(path.at(2 - 1e-9, 960, 540), data.keyframes[2].camera), 1e-6);
  // The part before the cut does not depend on the part after it.
  CameraPathData before = data;
  before.keyframes.resize(3);
  for (double t = 0; t < 2; t += 0.1)
    EXPECT_EQ(
        largest_difference(path.at(t, width, height), CameraPath(before).at(t, width, height)), 0);
}

TEST(CameraPath, WhatRisesFromKeyframeToKeyframeRisesInBetween) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    CameraPathData data;
    double seconds = 0, focal = 100;
    for (int i = 0; i < 8; ++i) {
      CameraKeyframe keyframe = random_keyframe(random, seconds, false);
      keyframe.camera.fx = keyframe.camera.fy = focal;
      data.keyframes.push_back(keyframe);
      // Times are far from even, which makes other splines overshoot.
      seconds += std::pow(10.0, random.uniform(-1.5, 1));
      focal *= std::exp(std::pow(10.0, random.uniform(-2, 0)));
    }
    const CameraPath path(data);
    double before = 0;
    for (double part = 0; part <= 1; part += 0.0005) {
      const double fy = path.at(part * path.duration(), 960, 540).fy;
      EXPECT_GE(fy, before * (1 - 1e-12)) << part;
      before = fy;
    }
  }
}

TEST(CameraPath, ATurntableIsAnExactCircle) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const double size = std::pow(10.0, random.uniform(-6, 8));
    const glm::dvec3 up = random.direction(), target = size * random.direction();
    const glm::dvec3 eye = target + 3 * size * random.direction();
    Camera first = look_at(eye, target, up, 0.7, width, height);
    first.cx += 10;
    const double distance = glm::length(eye - target), seconds = random.uniform(1, 20);
    const int turns = random.chance(0.5) ? 1 : -2;
    const CameraPath path(turntable({.first = first,
                                     .distance = distance,
                                     .up = 3.0 * up,
                                     .seconds = seconds,
                                     .turns = turns}));
    EXPECT_DOUBLE_EQ(path.duration(), seconds);
    for (int i = 0; i < 100; ++i) {
      const double t = random.uniform(0, seconds);
      // The exact circle: Rodrigues' formula for eye and axes.
      const double angle = 2 * pi * turns * t / seconds;
      const auto turned = [&](const glm::dvec3& v) {
        return std::cos(angle) * v + std::sin(angle) * glm::cross(up, v) +
               (1 - std::cos(angle)) * glm::dot(up, v) * up;
      };
      const Camera camera = path.at(t, width, height);
      // The tolerance of the header. Coordinates are at most the distance here, and view_from_world
      // adds two roundings.
      EXPECT_LT(glm::length(camera.eye() - (target + turned(eye - target))), 1e-12 * distance);
      for (int k = 0; k < 3; ++k)
        EXPECT_LT(glm::length(camera.world_from_view_rotation()[k] -
                              turned(first.world_from_view_rotation()[k])),
                  1e-12);
      EXPECT_EQ(camera.cx, first.cx);
    }
  }
}

TEST(CameraPath, ATurntableOfASubjectShowsAllOfItFromEverywhere) {
  const Subject subject{{-3, -1, -0.5}, {3, 1, 0.5}, {0, 0, 2}};
  const Lens lens{width, height};
  const CameraPath path(turntable(subject, {0, orbit_elevation}, lens, 6));
  double largest = 0;
  for (int i = 0; i < 300; ++i) {
    const Camera camera = path.at(i * 0.02, width, height);
    EXPECT_NEAR(camera.eye().z, path.at(0, width, height).eye().z, 1e-12);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p(corner & 1 ? -3 : 3, corner & 2 ? -1 : 1, corner & 4 ? -0.5 : 0.5, 1);
      const glm::dvec3 v(camera.view_from_world * p);
      largest = std::max({largest, std::abs(camera.fx * v.x / v.z) / (0.5 * width),
                          std::abs(camera.fy * v.y / v.z) / (0.5 * height)});
    }
  }
  EXPECT_LT(largest, 1);
  EXPECT_GT(largest, 0.94);
}

TEST(CameraPath, KeyframesAreAddedMovedReplacedAndRemoved) {
  Random random(11);
  CameraPath path;
  EXPECT_EQ(path.add(random_keyframe(random, 1, false)), 0u);
  EXPECT_EQ(path.add(random_keyframe(random, 3, false)), 1u);
  EXPECT_EQ(path.add(random_keyframe(random, 2, false)), 1u);
  EXPECT_EQ(path.duration(), 2);
  const CameraKeyframe other = random_keyframe(random, 77, false);
  path.replace(1, other);
  EXPECT_EQ(path.data().keyframes[1].seconds, 2);
  EXPECT_LT(largest_difference(path.at(2, 960, 540), other.camera), 1e-13);
  EXPECT_EQ(path.move(1, 5), 2u);
  EXPECT_LT(largest_difference(path.at(5, 960, 540), other.camera), 1e-13);
  path.set_loop_seconds(6);
  EXPECT_TRUE(path.is_loop());
  EXPECT_EQ(path.duration(), 6);
  path.remove(2);
  EXPECT_EQ(path.data().keyframes.size(), 2u);
  path.remove(0);
  path.remove(0);
  EXPECT_TRUE(path.empty());
  // A path built by calls equals a path from a file.
  CameraPathData data = random_path(random);
  CameraPath by_hand;
  for (const CameraKeyframe& keyframe : data.keyframes) by_hand.add(keyframe);
  by_hand.set_loop_seconds(data.loop_seconds);
  EXPECT_EQ(
      largest_difference(by_hand.at(3.3, width, height), CameraPath(data).at(3.3, width, height)),
      0);
}

TEST(CameraPath, FramesCoverItOnce) {
  Random random(12);
  CameraPathData data;
  for (int i = 0; i < 4; ++i) data.keyframes.push_back(random_keyframe(random, 1 + i, false));
  const FrameRate rate{10, width, height};
  const std::vector<Camera> ends = frames(CameraPath(data), rate);
  ASSERT_EQ(ends.size(), 31u);
  EXPECT_LT(largest_difference(ends.back(), resized(data.keyframes[3].camera, width, height)),
            1e-12);
  EXPECT_EQ(ends[30].name, "frame 30");
  data.loop_seconds = 4;
  const std::vector<Camera> loop = frames(CameraPath(data), rate);
  ASSERT_EQ(loop.size(), 40u);
  EXPECT_LT(largest_difference(loop[10], resized(data.keyframes[1].camera, width, height)), 1e-9);
  EXPECT_EQ(frames(CameraPath(), rate).size(), 0u);
  EXPECT_EQ(frame_count(CameraPath({.keyframes = {data.keyframes[0]}}), 30), 1);
}

TEST(CameraSpline, RotationVectorsGoThereAndBack) {
  Random random(13);
  for (int i = 0; i < 1000; ++i) {
    const double angle = std::pow(10.0, random.uniform(-18, 0.49));  // up to 3.09
    const glm::dvec3 v = angle * random.direction();
    // A quaternion has an error of 4e-16. Near half a turn, the angle is most sensitive to it.
    EXPECT_LT(glm::length(rotation_vector(rotation_of_vector(v)) - v), 4e-15 * angle + 1e-30) << i;
    const glm::dquat q = rotation_of_vector(v);
    EXPECT_EQ(rotation_vector(q), rotation_vector(glm::dquat(-q.w, -q.x, -q.y, -q.z)));
  }
}

}  // namespace camera_path_test
}  // namespace tureen
