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

const Lens barrel = brown({.k1 = -0.12, .k2 = 0.03, .p1 = 0.004, .p2 = -0.003});
const Lens pincushion = brown({.k1 = 0.06, .k2 = 0.02, .k3 = -0.01, .p1 = -0.002, .p2 = 0.003});

TEST(Lens, DistortsByTheFormula) {
  const Lens lens = brown({.k1 = 0.1, .k2 = -0.2, .k3 = 0.3, .p1 = 0.01, .p2 = 0.02});
  // x = 0.5, y = -1, r^2 = 1.25: radial = 1 + 0.125 - 0.3125 + 0.5859375 = 1.3984375.
  const glm::dvec2 place = lens.distorted({0.5, -1});
  // 2 p1 x y = -0.01, p2 (r^2 + 2 x^2) = 0.035; 2 p2 x y = -0.02, p1 (r^2 + 2 y^2) = 0.0325.
  EXPECT_NEAR(place.x, 0.69921875 - 0.01 + 0.035, 1e-15);
  EXPECT_NEAR(place.y, -1.3984375 - 0.02 + 0.0325, 1e-15);
  EXPECT_TRUE(Lens{}.is_pinhole());
  EXPECT_FALSE(brown({.p1 = 1e-9}).is_pinhole());
}

TEST(Lens, SeesNothingBeyondItsFold) {
  const Lens lens = brown({.k1 = -0.5});  // r (1 - r^2 / 2) decreases beyond r^2 = 2 / 3
  EXPECT_TRUE(lens.sees({0.81, 0}));
  EXPECT_FALSE(lens.sees({0, 0.83}));
  // With k2 it increases again, but nearer points hide the part beyond the fold.
  const Lens twice = brown({.k1 = -0.5, .k2 = 0.08});
  EXPECT_FALSE(twice.sees({1.2, 0}));
  EXPECT_FALSE(twice.sees({2.5, 0}));
  EXPECT_TRUE(Lens{}.sees({100, 100}));
  EXPECT_FALSE(brown({.k1 = std::numeric_limits<double>::quiet_NaN()}).sees({0.1, 0}));
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

const Lens wide = fisheye({.k1 = -0.03, .k2 = 0.01, .k3 = -0.004, .k4 = 0.001});

TEST(Lens, AFisheyeMapsAnglesByTheFormula) {
  // Without coefficients, the distance from the axis is the angle: atan(3/4) in direction (3, 4)/5.
  const Lens plain = fisheye({});
  EXPECT_FALSE(plain.is_pinhole());
  const glm::dvec2 place = plain.distorted({0.45, 0.6});
  EXPECT_NEAR(place.x, 0.6 * std::atan(0.75), 1e-15);
  EXPECT_NEAR(place.y, 0.8 * std::atan(0.75), 1e-15);
  EXPECT_EQ(plain.distorted({0, 0}), glm::dvec2(0));
  EXPECT_TRUE(plain.sees({1e6, 0}));
  // At 45 degrees along x, term by term.
  const double t = std::atan(1.0), t2 = t * t;
  EXPECT_NEAR(wide.distorted({1, 0}).x,
              t - 0.03 * t * t2 + 0.01 * t * t2 * t2 - 0.004 * t * std::pow(t2, 3) +
                  0.001 * t * std::pow(t2, 4),
              1e-15);
  // theta - theta^3 / 3 decreases beyond 1 radian.
  const Lens folds = fisheye({.k1 = -1.0 / 3});
  EXPECT_TRUE(folds.sees({std::tan(0.97), 0}));
  EXPECT_FALSE(folds.sees({0, std::tan(1.05)}));
}

/// The formulas of COLMAP's other models at one point, term by term.
TEST(Lens, OtherModelsMapByTheirFormulas) {
  const glm::dvec2 point(0.3, -0.4);  // r = 0.5
  const auto at = [&](const LensModel& model, std::vector<double> c) {
    return lens_of(model, c).distorted(point);
  };
  const auto expect = [](glm::dvec2 found, double x, double y) {
    EXPECT_NEAR(found.x, x, 1e-14);
    EXPECT_NEAR(found.y, y, 1e-14);
  };
  // k4 to k6 divide: (1 + 0.1 / 4) / (1 + 0.2 / 4 + 0.3 / 16 + 0.4 / 64).
  const double quotient = 1.025 / 1.075;
  expect(at(brown_model, {0.1, 0, 0, 0, 0, 0.2, 0.3, 0.4}), 0.3 * quotient, -0.4 * quotient);
  const double fov = std::atan(std::tan(0.4)) / 0.8 / 0.5;  // 2 r tan(omega / 2) = tan(0.4)
  expect(at(fov_model, {0.8}), 0.3 * fov, -0.4 * fov);
  EXPECT_NEAR(lens_of(fov_model, std::array{0.8}).distorted({1e-9, 0}).x,
              1e-9 * 2 * std::tan(0.4) / 0.8, 1e-22);
  // The division model gives r of r': 0.5 = r' / (1 + k r'^2).
  const glm::dvec2 divided = at(division_model, {-0.2});
  const double r = glm::length(divided);
  EXPECT_NEAR(r / (1 - 0.2 * r * r), 0.5, 1e-14);
  EXPECT_NEAR(divided.x / divided.y, -0.75, 1e-14);
  const double eucm = 0.6 * std::sqrt(1.1 * 0.25 + 1) + 0.4;
  expect(at(eucm_model, {0.6, 1.1}), 0.3 / eucm, -0.4 / eucm);
  // Fisheyes: (a, b) is the point at its angle.
  const double t = std::atan(0.5), a = 0.6 * t, b = -0.8 * t, t2 = t * t;
  const double radial =
      1 + 0.01 * t2 + 0.02 * t2 * t2 + 0.03 * std::pow(t, 6) + 0.04 * std::pow(t, 8);
  expect(at(thin_prism_model, {0.01, 0.02, 0.5, 0.6, 0.03, 0.04, 0.7, 0.8}),
         a * radial + 2 * 0.5 * a * b + 0.6 * (t2 + 2 * a * a) + 0.7 * t2,
         b * radial + 2 * 0.6 * a * b + 0.5 * (t2 + 2 * b * b) + 0.8 * t2);
  double six = 1;
  const double k[] = {0.01, 0.02, 0.03, 0.04, 0.05, 0.06};
  for (int i = 0; i < 6; ++i) six += k[i] * std::pow(t, 2 * i + 2);
  const double u = a * six, v = b * six, s = u * u + v * v;
  expect(at(rad_tan_thin_prism_model,
            {0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}),
         u + 2 * 0.2 * u * v + 0.1 * (s + 2 * u * u) + 0.3 * s + 0.4 * s * s,
         v + 2 * 0.1 * u * v + 0.2 * (s + 2 * v * v) + 0.5 * s + 0.6 * s * s);
}

TEST(Lens, OtherModelsAreUndone) {
  for (const Lens& lens :
       {lens_of(fov_model, std::array{0.6}), lens_of(division_model, std::array{-0.1}),
        lens_of(division_model, std::array{0.05}), lens_of(eucm_model, std::array{0.4, 1.1}),
        lens_of(thin_prism_model, std::array{-0.03, 0.01, 0.001, -0.002, 0.0, 0.0, 0.003, 0.002}),
        brown({.k1 = -0.1, .k4 = 0.02})}) {
    SCOPED_TRACE(lens.model->name);
    expect_the_scene(lens);
  }
}

TEST(Lens, SeesNothingWhereTheDivisionModelHasNoImage) {
  const Lens lens = lens_of(division_model, std::array{0.5});  // up to r^2 = 1 / 2
  EXPECT_TRUE(lens.sees({0.7, 0}));
  EXPECT_FALSE(lens.sees({0, 0.72}));
}

TEST(Lens, AFisheyeIsUndone) {
  expect_the_scene(wide);
  // A camera of about 180 degrees: the pinhole image is a part of it, of 115 degrees, all known.
  Camera camera = a_camera();
  camera.fx = camera.fy = 200 / 3.14;
  const Image8 photograph(camera.width, camera.height, glm::u8vec4(10, 20, 30, 255));
  const PixelRectangle known = undistorted(photograph, camera, fisheye({})).known;
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
       {brown({.k1 = 30}), brown({.k1 = -8}), brown({.k1 = 1e300, .k2 = -1e300}), brown({.p1 = 40}),
        brown({.k3 = nan}), fisheye({.k1 = -40}), fisheye({.k4 = nan})}) {
    const PixelRectangle known = undistorted(photograph, camera, lens).known;
    EXPECT_EQ(known.right - known.left, 0) << lens.coefficients[0];
    EXPECT_EQ(known.right, 0);
  }
}

}  // namespace lens_test
}  // namespace tureen
