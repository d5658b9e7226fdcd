// The oracle's triangle windows, against the classic formula and its properties.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "oracle/oracle.hpp"
#include "oracle/window.hpp"
#include "tests/oracle/splats_in_view.hpp"

namespace tureen {
namespace oracle_windows_test {

using oracle::SplatView;
using oracle::WindowInView;

constexpr double near = 1e-3;

TriangleWindows one_window(const std::array<glm::dvec3, 3>& corners, float sigma = 1,
                           float opacity = 1) {
  return {{corners[0], corners[1], corners[2]}, {sigma}, {opacity}};
}

/// The corners in pixels, as the float corners of `windows` are seen. A corner behind the eye has
/// the image of its line through the eye.
std::array<glm::dvec2, 3> image_of(const TriangleWindows& windows, const Camera& camera) {
  std::array<glm::dvec2, 3> image;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 p(windows.corners[k]);
    image[k] = {camera.cx - camera.fx * p.x / p.z, camera.cy + camera.fy * p.y / p.z};
  }
  return image;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Signed distances from the lines of the edges opposite to each corner, positive on its side.
std::array<double, 3> distances(const std::array<glm::dvec2, 3>& q, const glm::dvec2& p) {
  std::array<double, 3> result;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec2 a = q[(k + 1) % 3], edge = q[(k + 2) % 3] - a;
    const double side = cross(edge, q[k] - a) > 0 ? 1 : -1;
    result[k] = side * cross(edge, p - a) / glm::length(edge);
  }
  return result;
}

std::array<double, 3> edge_lengths(const std::array<glm::dvec2, 3>& q) {
  std::array<double, 3> result;
  for (int k = 0; k < 3; ++k) result[k] = glm::length(q[(k + 2) % 3] - q[(k + 1) % 3]);
  return result;
}

double area(const std::array<glm::dvec2, 3>& q) {
  return std::abs(cross(q[1] - q[0], q[2] - q[0])) / 2;
}

class OracleWindows : public testing::Test {
 protected:
  Camera camera_ = test::straight_camera(160, 120, 100);
  SplatView view_{glm::dmat4(1.0), camera_, near};
  test::Random random_{1};

  glm::dvec2 random_pixel() { return {random_.uniform(0, 160), random_.uniform(0, 120)}; }
  TriangleWindows random_window() {
    std::array<glm::dvec3, 3> corners;
    for (glm::dvec3& corner : corners)
      corner = test::point_at(camera_, random_pixel(), random_.uniform(0.5, 5));
    return one_window(corners);
  }
  std::optional<WindowInView> project(const TriangleWindows& windows) const {
    return WindowInView::project(windows, 0, {}, view_);
  }
};

TEST_F(OracleWindows, EqualsTheClassicFormulaInFrontOfTheEye) {
  double largest_difference = 0;
  for (int i = 0; i < 300; ++i) {
    const TriangleWindows windows = random_window();
    const auto q = image_of(windows, camera_);
    const auto lengths = edge_lengths(q);
    const double perimeter = lengths[0] + lengths[1] + lengths[2];
    const double inradius = 2 * area(q) / perimeter;
    // The classic formula itself loses digits on needles.
    if (inradius < 0.1) continue;
    const auto window = project(windows);
    ASSERT_TRUE(window);
    const glm::dvec2 incenter =
        (lengths[0] * q[0] + lengths[1] * q[1] + lengths[2] * q[2]) / perimeter;
    EXPECT_NEAR(window->rho(incenter), 1, 1e-10);
    for (int j = 0; j < 30; ++j) {
      const glm::dvec2 pixel = random_pixel();
      const auto d = distances(q, pixel);
      const double classic = std::clamp(std::min({d[0], d[1], d[2]}) / inradius, 0.0, 1.0);
      largest_difference = std::max(largest_difference, std::abs(window->rho(pixel) - classic));
    }
    for (int k = 0; k < 3; ++k) {
      const double t = random_.uniform();
      EXPECT_NEAR(window->rho((1 - t) * q[k] + t * q[(k + 1) % 3]), 0, 1e-10);
    }
  }
  EXPECT_LT(largest_difference, 1e-10);
}

TEST_F(OracleWindows, DoesNotDependOnTheImageSize) {
  const double factor = 7;
  const Camera large = resized(camera_, 7 * 160, 7 * 120);
  const SplatView large_view(glm::dmat4(1.0), large, near);
  for (int i = 0; i < 100; ++i) {
    const TriangleWindows windows = random_window();
    const auto small = project(windows);
    const auto big = WindowInView::project(windows, 0, {}, large_view);
    ASSERT_TRUE(small && big);
    for (int j = 0; j < 10; ++j) {
      const glm::dvec2 pixel = random_pixel();
      EXPECT_NEAR(small->rho(pixel), big->rho(factor * pixel), 1e-10);
    }
  }
}

// Beyond the eye plane the window continues as the distance over the excircle's radius.
TEST_F(OracleWindows, UsesTheExcircleWithOneCornerBehind) {
  int drawn = 0;
  for (int i = 0; i < 300; ++i) {
    TriangleWindows windows = random_window();
    windows.corners[0] = -windows.corners[0];
    const auto q = image_of(windows, camera_);
    const auto lengths = edge_lengths(q);
    const double exradius = 2 * area(q) / (lengths[1] + lengths[2] - lengths[0]);
    if (exradius < 0.1 || area(q) < 10) continue;
    const auto window = project(windows);
    if (!window) continue;  // outside the image
    ++drawn;
    for (int j = 0; j < 30; ++j) {
      const glm::dvec2 pixel = random_pixel();
      // The visible part lies beyond edge 0.
      const auto d = distances(q, pixel);
      const double expected = std::clamp(std::min({-d[0], d[1], d[2]}) / exradius, 0.0, 1.0);
      // Some of it is nearer than the near plane.
      if (window->rho(pixel) != 0) {
        EXPECT_NEAR(window->rho(pixel), expected, 1e-10);
      }
    }
  }
  EXPECT_GT(drawn, 100);
}

TEST_F(OracleWindows, IsContinuousWhereACornerCrossesTheEyePlane) {
  const auto at = [&](double depth) {
    const TriangleWindows windows =
        one_window({glm::dvec3(-1, -1, -3), glm::dvec3(1, -1, -3), glm::dvec3(0.1, 2, -depth)});
    std::vector<double> values;
    const auto window = project(windows);
    for (int y = 0; y < 120; y += 5)
      for (int x = 0; x < 160; x += 5) values.push_back(window->rho({x + 0.5, y + 0.5}));
    return values;
  };
  const std::vector<double> before = at(1e-9), on = at(0), after = at(-1e-9);
  EXPECT_GT(*std::max_element(on.begin(), on.end()), 0.5);
  for (std::size_t i = 0; i < on.size(); ++i) {
    EXPECT_NEAR(before[i], on[i], 1e-7);
    EXPECT_NEAR(after[i], on[i], 1e-7);
  }
}

TEST_F(OracleWindows, WithTwoCornersBehindIsNotDrawn) {
  for (int i = 0; i < 100; ++i) {
    TriangleWindows windows = random_window();
    windows.corners[0] = -windows.corners[0];
    windows.corners[1] = -windows.corners[1];
    EXPECT_FALSE(project(windows));
  }
}

TEST_F(OracleWindows, ExistsOnlyBeyondTheNearPlane) {
  const TriangleWindows windows =
      one_window({glm::dvec3(-1, -1, -2), glm::dvec3(1, -1, -2), glm::dvec3(0, 1, -4)});
  const SplatView cut(glm::dmat4(1.0), camera_, 3.0);
  const auto whole = project(windows), part = WindowInView::project(windows, 0, {}, cut);
  ASSERT_TRUE(whole && part);
  int absent = 0, present = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const glm::dvec2 pixel(x + 0.5, y + 0.5);
      const oracle::SplatSample sample = whole->at(pixel);
      if (sample.alpha == 0) continue;
      if (sample.depth < 3) {
        ++absent;
        EXPECT_EQ(part->at(pixel).alpha, 0);
      } else {
        ++present;
        EXPECT_EQ(part->at(pixel).alpha, sample.alpha);
      }
    }
  EXPECT_GT(absent, 100);
  EXPECT_GT(present, 100);
}

// Precision at a short edge: two corners 1e-4 apart at distance 10.
TEST_F(OracleWindows, KeepsItsDigitsOnNeedles) {
  const float step = 1.0f / 8192;
  const TriangleWindows windows =
      one_window({glm::dvec3(0, 0, -10), glm::dvec3(step, 0, -10), glm::dvec3(0, 4, -10)});
  const auto window = project(windows);
  ASSERT_TRUE(window);
  // Half-way up, at the middle of the width: the distance from the edges at both sides over the
  // inradius, in units of the triangle's plane.
  const double width = step, height = 4, length = std::hypot(width, height);
  const double inradius = width * height / (width + height + length);
  const double distance = width / 4;
  const glm::dvec2 pixel(80 + 10 * distance, 60 - 10 * 2.0);
  // The other edge is at distance (width / 4) height / length.
  EXPECT_NEAR(window->rho(pixel), distance * height / length / inradius, 1e-9);
}

/// The barycentrics of an image point by signed areas.
std::array<double, 3> barycentrics(const std::array<glm::dvec2, 3>& q, const glm::dvec2& p) {
  std::array<double, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 a = q[(k + 1) % 3], edge = q[(k + 2) % 3] - a;
    result[k] = cross(edge, p - a) / cross(edge, q[k] - a);
  }
  return result;
}

TEST_F(OracleWindows, WeightsOfCornersAreBarycentricsInTheImage) {
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const TriangleWindows windows = random_window();
    const auto q = image_of(windows, camera_);
    if (area(q) < 10) continue;  // the classic formula itself loses digits on needles
    const auto window = project(windows);
    ASSERT_TRUE(window);
    for (int j = 0; j < 30; ++j) {
      const glm::dvec2 pixel = random_pixel();
      if (!(window->rho(pixel) > 0)) continue;
      ++inside;
      const auto expected = barycentrics(q, pixel), weights = window->corner_weights(pixel);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(weights[k], expected[k], 1e-10);
    }
  }
  EXPECT_GT(inside, 500);
}

// A corner near the eye's plane has hardly a weight, and beyond the plane none.
TEST_F(OracleWindows, WeightsAreContinuousWhereACornerCrossesTheEyePlane) {
  const auto at = [&](double depth, const glm::dvec2& pixel) {
    const auto window = project(
        one_window({glm::dvec3(-1, -1, -3), glm::dvec3(1, -1, -3), glm::dvec3(0.1, 2, -depth)}));
    EXPECT_GT(window->rho(pixel), 0);
    return window->corner_weights(pixel);
  };
  for (const glm::dvec2& pixel : {glm::dvec2(80, 50), glm::dvec2(70, 20), glm::dvec2(90, 5)}) {
    const auto before = at(1e-7, pixel), after = at(-1e-7, pixel), behind = at(-2, pixel);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(before[k], after[k], 1e-5);
    EXPECT_EQ(after[2], 0);
    EXPECT_EQ(behind[2], 0);
    EXPECT_NEAR(behind[0] + behind[1], 1, 1e-15);
    EXPECT_GT(std::min(behind[0], behind[1]), 0);
  }
}

// Half-way between two corners in the image, the colour is their mean, whatever their depths.
TEST_F(OracleWindows, ColoursOfCornersAreAffineInTheImage) {
  const Camera camera = test::straight_camera(33, 33, 50);
  const auto corner = [&](double x, double y, double depth) {
    return glm::vec3(test::point_at(camera, {x, y}, depth));
  };
  TriangleWindows windows;
  windows.corners = {corner(0.5, 4.5, 1), corner(32.5, 4.5, 20), corner(16.5, 30.5, 5)};
  windows.sigma = {1e-4f};
  windows.opacity = {1};
  Splats splats{windows, test::flat_colors({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
                *profile_named("mesh-splatting")};
  splats.color.per_corner = true;
  ASSERT_EQ(defect(splats), std::nullopt);
  for (const auto order : {oracle::SplatOrder::center, oracle::SplatOrder::exact}) {
    const OracleImage image = render_oracle(scene_of(splats), {camera}, {.splat_order = order});
    // From the middle of the first edge, 7 of 26 rows towards the third corner.
    const glm::vec4 pixel = image.color.at(16, 11);
    const double toward = 7.0 / 26;
    EXPECT_NEAR(pixel.r, 0.999 * (1 - toward) / 2, 1e-3);  // 1e-3: sigma takes 1e-4
    EXPECT_NEAR(pixel.g, 0.999 * (1 - toward) / 2, 1e-3);
    EXPECT_NEAR(pixel.b, 0.999 * toward, 1e-3);
  }
}

// specs/02, 2.1: at the front triangle's incenter the colour is 0.5 c1 + 0.495 c2 + 0.005
// background.
TEST_F(OracleWindows, TwoTrianglesBlendAsInThePaper) {
  // A right triangle with sides 3, 4 and 5 has its incenter at (1, 1) from the right angle.
  const glm::vec3 corners[3] = {{-1, -1, -10}, {3, -1, -10}, {-1, 2, -10}};
  TriangleWindows windows;
  for (const float scale : {2.0f, 1.0f})  // the rear triangle comes first
    for (const glm::vec3& corner : corners) windows.corners.push_back(scale * corner);
  windows.sigma = {1, 1};
  windows.opacity = {1, 0.5f};
  const Splats splats{windows, test::flat_colors({{0, 1, 0}, {1, 0, 0}}), {}};
  ASSERT_EQ(defect(splats), std::nullopt);
  const Camera camera = test::straight_camera(33, 33, 50);
  const OracleImage image =
      render_oracle(scene_of(splats), {camera}, {.background = glm::vec3(0, 0, 1)});
  const glm::vec4 pixel = image.color.at(16, 16);
  EXPECT_NEAR(pixel.r, 0.5, 1e-6);
  EXPECT_NEAR(pixel.g, 0.495, 1e-6);
  EXPECT_NEAR(pixel.b, 0.005, 1e-6);
  EXPECT_NEAR(image.splat_alpha[16 * 33 + 16], 0.995, 1e-6);
  EXPECT_NEAR(image.splat_depth[16 * 33 + 16], 10, 1e-12);
}

}  // namespace oracle_windows_test
}  // namespace tureen
