#include "formats/dataset/lens.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <random>

namespace tureen {
namespace lens_test {

/// Off centre and with non-square pixels, so that a swap of axes cannot stay unnoticed.
Camera a_camera() {
  Camera camera;
  camera.width = 200;
  camera.height = 150;
  camera.fx = 180;
  camera.fy = 171;
  camera.cx = 93.25;
  camera.cy = 81.5;
  return camera;
}

/// The scene point that appears at `place`, by Newton's method with finite differences. This
/// inverse shares only the lens model with the tested code. Requires a lens without a fold.
glm::dvec2 undo(const Lens& lens, glm::dvec2 place) {
  glm::dvec2 point = place;
  for (int i = 0; i < 30; ++i) {
    constexpr double h = 1e-6;
    const glm::dvec2 error = lens.distorted(point) - place;
    const glm::dvec2 dx =
        (lens.distorted(point + glm::dvec2(h, 0)) - lens.distorted(point - glm::dvec2(h, 0))) /
        (2 * h);
    const glm::dvec2 dy =
        (lens.distorted(point + glm::dvec2(0, h)) - lens.distorted(point - glm::dvec2(0, h))) /
        (2 * h);
    const double determinant = dx.x * dy.y - dx.y * dy.x;
    point -=
        glm::dvec2(error.x * dy.y - error.y * dy.x, error.y * dx.x - error.x * dx.y) / determinant;
  }
  return point;
}

/// The colour of the scene at depth 1: soft checks of some 20 pixels on a slope.
glm::dvec3 scene(glm::dvec2 p) {
  return {128 + 90 * std::sin(55 * p.x) * std::sin(52 * p.y), 128 + 150 * p.x, 128 + 150 * p.y};
}

/// The image of the scene through the lens.
Image8 photograph_of(const Camera& camera, const Lens& lens) {
  Image8 image(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const glm::dvec2 place((x + 0.5 - camera.cx) / camera.fx, (y + 0.5 - camera.cy) / camera.fy);
      image.at(x, y) = glm::u8vec4(glm::dvec4(scene(undo(lens, place)) + 0.5, 255));
    }
  return image;
}

const Lens barrel{.k1 = -0.12, .k2 = 0.03, .p1 = 0.004, .p2 = -0.003};
const Lens pincushion{.k1 = 0.06, .k2 = 0.02, .k3 = -0.01, .p1 = -0.002, .p2 = 0.003};

TEST(Lens, DistortsByTheFormula) {
  const Lens lens{.k1 = 0.1, .k2 = -0.2, .k3 = 0.3, .p1 = 0.01, .p2 = 0.02};
  // x = 0.5, y = -1, r^2 = 1.25: radial = 1 + 0.125 - 0.3125 + 0.5859375 = 1.3984375.
  const glm::dvec2 place = lens.distorted({0.5, -1});
  // 2 p1 x y = -0.01, p2 (r^2 + 2 x^2) = 0.035; 2 p2 x y = -0.02, p1 (r^2 + 2 y^2) = 0.0325.
  EXPECT_NEAR(place.x, 0.69921875 - 0.01 + 0.035, 1e-15);
  EXPECT_NEAR(place.y, -1.3984375 - 0.02 + 0.0325, 1e-15);
  EXPECT_TRUE(Lens{}.is_pinhole());
  EXPECT_FALSE(Lens{.p1 = 1e-9}.is_pinhole());
}

TEST(Lens, SeesNothingBeyondItsFold) {
  const Lens lens{.k1 = -0.5};  // r (1 - r^2 / 2) decreases beyond r^2 = 2 / 3
  EXPECT_TRUE(lens.sees({0.81, 0}));
  EXPECT_FALSE(lens.sees({0, 0.83}));
  // With k2 it increases again, but nearer points hide the part beyond the fold.
  const Lens twice{.k1 = -0.5, .k2 = 0.08};
  EXPECT_FALSE(twice.sees({1.2, 0}));
  EXPECT_FALSE(twice.sees({2.5, 0}));
  EXPECT_TRUE(Lens{}.sees({100, 100}));
  EXPECT_FALSE(Lens{.k1 = std::numeric_limits<double>::quiet_NaN()}.sees({0.1, 0}));
}

void expect_the_scene(const Lens& lens) {
  const Camera camera = a_camera();
  const Undistorted result = undistorted(photograph_of(camera, lens), camera, lens);
  const PixelRectangle& known = result.known;
  ASSERT_GT(known.right - known.left, 170);
  ASSERT_GT(known.bottom - known.top, 125);
  double worst = 0, sum = 0;
  int count = 0;
  for (int y = known.top; y < known.bottom; ++y)
    for (int x = known.left; x < known.right; ++x) {
      const glm::dvec2 point((x + 0.5 - camera.cx) / camera.fx, (y + 0.5 - camera.cy) / camera.fy);
      const glm::dvec3 want = scene(point);
      for (int c = 0; c < 3; ++c) {
        const double error = std::abs(double(result.image.at(x, y)[c]) - want[c]);
        worst = std::max(worst, error);
        sum += error;
        ++count;
      }
    }
  // The error is 0.31 on average: rounding to a byte twice, and a small error of the cubic. A shift
  // of half a pixel would give 2.1. At the edge the photograph is extended by its last pixel, so
  // the error may reach half a pixel times the slope of the checks, 27 a pixel.
  EXPECT_LT(sum / count, 0.4);
  EXPECT_LT(worst, 14);
}

TEST(Lens, ABarrelIsUndone) { expect_the_scene(barrel); }
TEST(Lens, APincushionIsUndone) { expect_the_scene(pincushion); }

const Lens fisheye{.model = LensModel::fisheye, .k1 = -0.03, .k2 = 0.01, .k3 = -0.004, .k4 = 0.001};

TEST(Lens, AFisheyeMapsAnglesByTheFormula) {
  // Without coefficients, the distance from the axis is the angle: atan(3/4) in direction (3, 4)/5.
  const Lens plain{.model = LensModel::fisheye};
  EXPECT_FALSE(plain.is_pinhole());
  const glm::dvec2 place = plain.distorted({0.45, 0.6});
  EXPECT_NEAR(place.x, 0.6 * std::atan(0.75), 1e-15);
  EXPECT_NEAR(place.y, 0.8 * std::atan(0.75), 1e-15);
  EXPECT_EQ(plain.distorted({0, 0}), glm::dvec2(0));
  EXPECT_TRUE(plain.sees({1e6, 0}));
  // At 45 degrees along x, term by term.
  const double t = std::atan(1.0), t2 = t * t;
  EXPECT_NEAR(fisheye.distorted({1, 0}).x,
              t - 0.03 * t * t2 + 0.01 * t * t2 * t2 - 0.004 * t * std::pow(t2, 3) +
                  0.001 * t * std::pow(t2, 4),
              1e-15);
  // theta - theta^3 / 3 decreases beyond 1 radian.
  const Lens folds{.model = LensModel::fisheye, .k1 = -1.0 / 3};
  EXPECT_TRUE(folds.sees({std::tan(0.97), 0}));
  EXPECT_FALSE(folds.sees({0, std::tan(1.05)}));
}

TEST(Lens, AFisheyeIsUndone) {
  expect_the_scene(fisheye);
  // A camera of about 180 degrees: the pinhole image is a part of it, of 115 degrees, all known.
  Camera camera = a_camera();
  camera.fx = camera.fy = 200 / 3.14;
  const Image8 photograph(camera.width, camera.height, glm::u8vec4(10, 20, 30, 255));
  const PixelRectangle known = undistorted(photograph, camera, {.model = LensModel::fisheye}).known;
  EXPECT_EQ(known.left, 0);
  EXPECT_EQ(known.top, 0);
  EXPECT_EQ(known.right, camera.width);
  EXPECT_EQ(known.bottom, camera.height);
}

TEST(Lens, WithoutDistortionNothingChanges) {
  const unsigned seed = 3;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const Camera camera = a_camera();
  Image8 image(camera.width, camera.height);
  for (glm::u8vec4& pixel : image.pixels)
    for (int c = 0; c < 4; ++c) pixel[c] = glm::u8(random());
  const Undistorted result = undistorted(image, camera, {});
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (image.pixels[i].a > 0) {
      // These colours were multiplied by alpha and divided again.
      ASSERT_EQ(result.image.pixels[i], image.pixels[i]) << i;
    } else {
      ASSERT_EQ(result.image.pixels[i].a, 0) << i;
    }
  EXPECT_EQ(result.known.left, 0);
  EXPECT_EQ(result.known.top, 0);
  EXPECT_EQ(result.known.right, camera.width);
  EXPECT_EQ(result.known.bottom, camera.height);
}

TEST(Lens, WhatHasNoSourceIsTransparentAndOutsideOfTheKnownRectangle) {
  const Camera camera = a_camera();
  const Image8 photograph(camera.width, camera.height, glm::u8vec4(10, 20, 30, 255));
  const Undistorted result = undistorted(photograph, camera, pincushion);
  const Image8& image = result.image;
  const PixelRectangle& known = result.known;
  int transparent = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const glm::dvec2 place = pincushion.distorted({(x + 0.5 - camera.cx) / camera.fx,
                                                     (y + 0.5 - camera.cy) / camera.fy}) *
                                   glm::dvec2(camera.fx, camera.fy) +
                               glm::dvec2(camera.cx, camera.cy);
      const bool inside = place.x >= 0 && place.y >= 0 && place.x <= 200 && place.y <= 150;
      ASSERT_EQ(image.at(x, y), glm::u8vec4(10, 20, 30, inside ? 255 : 0)) << x << ' ' << y;
      transparent += !inside;
      if (x >= known.left && x < known.right && y >= known.top && y < known.bottom) {
        ASSERT_TRUE(inside) << x << ' ' << y;
      }
    }
  EXPECT_GT(transparent, 100);
  // The rectangle cannot grow at any side.
  const auto unknown_in = [&](int left, int top, int right, int bottom) {
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x)
        if (image.at(x, y).a == 0) return true;
    return false;
  };
  EXPECT_TRUE(unknown_in(known.left - 1, known.top, known.left, known.bottom));
  EXPECT_TRUE(unknown_in(known.right, known.top, known.right + 1, known.bottom));
  EXPECT_TRUE(unknown_in(known.left, known.top - 1, known.right, known.top));
  EXPECT_TRUE(unknown_in(known.left, known.bottom, known.right, known.bottom + 1));
}

TEST(Lens, ColoursAreWeighedByAlpha) {
  const Camera camera = a_camera();
  Image8 image(camera.width, camera.height, glm::u8vec4(255, 0, 255, 0));
  for (int y = 50; y < 100; ++y)
    for (int x = 60; x < 140; ++x) image.at(x, y) = glm::u8vec4(40, 80, 120, 255);
  const Undistorted result = undistorted(image, camera, barrel);
  int partly = 0;
  for (const glm::u8vec4& pixel : result.image.pixels) {
    if (pixel.a == 0) continue;
    ASSERT_EQ(glm::u8vec3(pixel), glm::u8vec3(40, 80, 120));
    partly += pixel.a < 255;
  }
  EXPECT_GT(partly, 100);
}

TEST(Lens, WhatLeavesTooLittleKnowsNothing) {
  const Camera camera = a_camera();
  const Image8 photograph(camera.width, camera.height, glm::u8vec4(255));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Lens& lens :
       {Lens{.k1 = 30}, Lens{.k1 = -8}, Lens{.k1 = 1e300, .k2 = -1e300}, Lens{.p1 = 40},
        Lens{.k3 = nan}, Lens{.model = LensModel::fisheye, .k1 = -40},
        Lens{.model = LensModel::fisheye, .k4 = nan}}) {
    const PixelRectangle known = undistorted(photograph, camera, lens).known;
    EXPECT_EQ(known.right - known.left, 0) << lens.k1 << ' ' << lens.p1;
    EXPECT_EQ(known.right, 0);
  }
}

}  // namespace lens_test
}  // namespace tureen
