// Extreme cameras: cases C1 to C4.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {
namespace camera_test {

/// Compares the device with the oracle for stressed cameras.
class Comparison {
 public:
  Comparison(const std::string& stressed, const std::string& parameter)
      : faces_({.stressed = stressed + ": device against oracle",
                .parameter = parameter,
                .unit = "fraction of pixels that show another face"}),
        colors_({.stressed = stressed + ": the colours where both show one face",
                 .parameter = parameter,
                 .unit = "error of a channel beyond half a step of 8 bits, where it is nearest to "
                         "its bound"}) {}

  /// `moved`: distance in pixels that roundings may move a corner. On average, an edge then sweeps
  /// over the centres of 2 `moved` of the pixels along it (see swept() in relations_test.cpp).
  /// Chance allows more, but at most H10's bound for everything, 1e-4 of the image.
  void add(double at, const TriangleSoup& soup, const Camera& camera, double moved) {
    const OracleImage expected = snapped_oracle(soup, glm::dvec3(0), camera);
    const Drawn drawn = draw(shared_context(), soup, glm::dvec3(0), camera);
    const Agreement found = agreement(expected, drawn);
    std::size_t edges = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const std::size_t i = std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
        edges += (x > 0 && expected.face[i] != expected.face[i - 1]) ||
                 (y > 0 && expected.face[i] != expected.face[i - std::size_t(camera.width)]);
      }
    const double pixels = double(camera.width) * camera.height, mean = 2 * moved * double(edges);
    faces_.add({.at = at,
                .ours = found.coverage_mismatch + found.face_mismatch,
                .tolerance = std::min(most_of(mean), mean + 1e-4 * pixels) / pixels});
    const ColorError colors = color_error(soup, glm::dvec3(0), camera, expected, drawn);
    EXPECT_GE(colors.compared, AgreementLimits().min_compared)
        << at << ": too few pixels to compare";
    colors_.add({.at = at, .ours = colors.beyond, .tolerance = colors.allowed});
  }

 private:
  Recorder faces_, colors_;
};

TEST(Numerics, C1_FieldsOfViewFromATenthTo179Degrees) {
  Comparison comparison("fields of view", "vertical field of view / degrees");
  constexpr int width = 320, height = 240;
  for (const double degrees : {0.1, 1.0, 10.0, 60.0, 120.0, 170.0, 179.0}) {
    const double half = glm::radians(degrees) / 2;
    // The eye is where the unit ball fills the image, or inside the ball.
    const double distance = std::max(1.1 / std::tan(half), 0.05);
    Random random(1);
    const Camera camera =
        look_at(distance * random.direction(), {0, 0, 0}, {0, 0, 1}, 2 * half, width, height);
    const TriangleSoup soup = random_soup(71, {.kind = Kind::lattice, .size = 0.2});
    // Subtracting the eye rounds a corner in proportion to the distance; it is seen from that
    // distance.
    const double in_pixels = camera.fy * std::max(1.0, std::tan(half));
    comparison.add(degrees, soup, camera, vertex_rounding(in_pixels));
  }
}

TEST(Numerics, C2_PrincipalPointsOutsideTheImage) {
  Comparison comparison("principal points outside of the image",
                        "its distance from the middle / widths");
  constexpr int width = 320, height = 240;
  // With a network, whose colours depend on the view direction.
  const TriangleSoup soup = random_soup(72, {.kind = Kind::lattice_mlp, .size = 0.2});
  for (const double widths : {0.0, 0.6, 1.0, 3.0, 10.0}) {
    Camera camera = look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.7, width, height);
    // The camera moves so that the soup stays in the middle: it is seen from the side.
    const double shift = widths * width;
    camera.cx += shift;
    camera.view_from_world[3] += glm::dvec4(-shift / camera.fx * 4, 0, 0, 0);
    // x is the sum of two terms of about `shift` that nearly cancel: the corner's distance from the
    // axis, and the principal point. Each has five roundings. The roundings of w scale with the
    // position in the image, those of the corner minus the eye with `shift`. Together they are at
    // most the roundings of a coordinate of shift + width.
    comparison.add(widths, soup, camera, vertex_rounding(shift + width));
  }
}

// A point far off the axis is far away but has a small depth. Depth planes use only the depth along
// the axis.
TEST(Numerics, C2b_WhatLiesFarOffTheAxisIsNotClipped) {
  Recorder recorder({.stressed = "a plate at a depth of 5, far off the axis: device and oracle",
                     .parameter = "angle off the axis / degrees",
                     .unit = "of 1024 pixels missing or too many",
                     .naive = "near plane by the distance to the eye, in the trainer"});
  constexpr int side = 64;
  for (const bool reversed : {true, false})
    for (const double degrees : {0.0, 45.0, 70.0, 80.0, 85.0, 89.0, 89.9}) {
      Camera camera = straight_camera(side, side, side);
      const double off = 5 * std::tan(glm::radians(degrees));
      // In the middle of the image: 32 pixels of 64 both ways.
      camera.cx -= camera.fx * off / 5;
      const auto corner = [&](double x, double y) { return glm::vec3(off + x, y, -5); };
      const double a = 1.25;
      const TriangleSoup soup = soup_of({corner(-a, -a), corner(a, -a), corner(a, a),
                                         corner(-a, -a), corner(a, a), corner(-a, a)});
      const double device = shown_pixels(faces_of_device(soup, camera, reversed));
      const double in_oracle = shown_pixels(faces_of_oracle(soup, camera));
      // The scene is the plate alone, so only a near plane that is too far away clips anything.
      const Bounds box = bounds(soup);
      const double by_distance = 0.95 * (glm::length(box.center()) - box.radius());
      const double clipped = shown_pixels(faces_of_trainer(soup, camera, by_distance, 1e5));
      // Corners are floats near `off`, and the principal point is as far away. Their roundings move
      // the plate's four borders of 32 pixels.
      const double moved = vertex_rounding(camera.fx * off / 5) + camera.fx / 5 * off * epsilon;
      recorder.add({.at = degrees,
                    .naive = std::abs(clipped - 1024),
                    .ours = std::abs(device - 1024) + std::abs(in_oracle - 1024),
                    .tolerance = std::floor(moved + 0.5) * 4 * 32});
    }
}

TEST(Numerics, C3_ImagesOfOnePixelAndOfOneRow) {
  Comparison comparison("images of 1x1, 1x4096, 4096x1 and 16384x16 pixels", "pixels");
  struct Size {
    int width, height;
  };
  const TriangleSoup soup = random_soup(73, {.kind = Kind::lattice, .size = 0.3});
  // Aimed at a face, so that the single pixel shows a face.
  Camera narrow;
  double shown = 0;
  for (std::size_t t = 0; t < soup.triangles.size() && shown == 0; ++t) {
    const glm::uvec3& corners = soup.triangles[t];
    const glm::dvec3 middle = glm::dvec3(soup.positions[corners[0]] + soup.positions[corners[1]] +
                                         soup.positions[corners[2]]) /
                              3.0;
    narrow = look_at({0.3, -0.2, 3}, middle, {0, 1, 0}, 0.9, 100, 100);
    shown = shown_pixels(faces_of_oracle(soup, resampled(narrow, 1, 1)));
  }
  for (const auto& [width, height] : {Size{1, 1}, Size{1, 4096}, Size{4096, 1}, Size{16384, 16}}) {
    // The same image on another pixel grid.
    const Camera camera = resampled(narrow, width, height);
    // A coordinate's rounding scales with the image side along its axis; edges have all directions.
    comparison.add(double(width) * height, soup, camera,
                   vertex_rounding(std::max(camera.width, camera.height)));
  }
}

TEST(Numerics, C4_SomethingVeryFarHidesNothingNear) {
  Recorder recorder({.stressed = "one face very far away behind a scene of size 1 about the eye: "
                                 "reversed depth",
                     .parameter = "its distance / distance of the near face",
                     .unit = "fraction of the near face's pixels that are lost",
                     .naive = "24 bits, near at a thousandth of the radius: the documented limit"});
  constexpr int side = 64;
  const Camera camera = straight_camera(side, side, side);
  for (const float far : {1e1f, 1e3f, 1e5f, 1e6f, 1e7f, 1e8f}) {
    const float a = 0.3f;
    // A face at distance 1, a face around the eye, and the far face.
    const std::vector<glm::vec3> corners = {{-a, -a, -1},       {a, -a, -1},       {0, a, -1},
                                            {2, 2, 2},          {2, 1, 2},         {1, 2, 2},
                                            {-far, -far, -far}, {far, -far, -far}, {0, far, -far}};
    const TriangleSoup soup = soup_of(corners);
    const auto near_face = [](const std::vector<std::uint32_t>& faces) {
      return double(std::count(faces.begin(), faces.end(), 0u));
    };
    const double expected = near_face(faces_of_oracle(
        soup_of(std::vector<glm::vec3>(corners.begin(), corners.begin() + 6)), camera));
    ASSERT_GT(expected, 100);
    const double ours = std::abs(near_face(faces_of_device(soup, camera)) - expected) +
                        std::abs(near_face(faces_of_oracle(soup, camera)) - expected);
    const double naive = std::abs(near_face(faces_of_device(soup, camera, false)) - expected);
    recorder.add(
        {.at = double(far), .naive = naive / expected, .ours = ours / expected, .tolerance = 0});
    // The documented limit: a near plane at a thousandth of the radius hides everything nearer, and
    // nothing else.
    const double near = 1e-3 * bounds(soup).radius();
    EXPECT_EQ(naive, near > 1 ? expected : 0) << far;
  }
}

}  // namespace camera_test
}  // namespace tureen::test
