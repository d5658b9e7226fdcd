// Numerical hazards of triangle windows: division by a small w, rounded vertices, extreme sigmas.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "tests/numerics/splat_scenes.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {
namespace splat_windows_test {

constexpr int width = 64, height = 48;

/// Also with the centre at the eye or behind it.
SplatProfile window_profile() {
  SplatProfile profile = *profile_named("triangle-splatting");
  profile.min_center_depth = 0;
  return profile;
}

/// rho in floats, from corners in pixels: the distances from the edges over the inradius.
float rho_in_image(const std::array<glm::vec2, 3>& corners, const glm::vec2& pixel) {
  const auto cross = [](const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; };
  const float area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const float sign = area < 0 ? -1.0f : 1.0f;
  float perimeter = 0, nearest = 3e38f;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec2 edge = corners[(k + 1) % 3] - corners[k];
    perimeter += glm::length(edge);
    nearest = std::min(nearest, sign * cross(edge, pixel - corners[k]) / glm::length(edge));
  }
  return std::clamp(nearest / (std::abs(area) / perimeter), 0.0f, 1.0f);
}

/// The window's alpha in floats, with every corner divided by its w.
float alpha_after_division(const TriangleWindows& windows, const Camera& camera, int x, int y) {
  std::array<glm::vec2, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3& p = windows.corners[k];
    corners[k] = {float(camera.cx) - float(camera.fx) * p.x / p.z,
                  float(camera.cy) + float(camera.fy) * p.y / p.z};
  }
  const float rho = rho_in_image(corners, {float(x) + 0.5f, float(y) + 0.5f});
  return windows.opacity[0] * std::pow(rho, windows.sigma[0]);
}

TEST(Numerics, W14_WindowsCrossTheNearPlane) {
  const Camera camera = straight_camera(width, height, width);
  for (const int behind : {1, 2}) {
    Recorder recorder({.stressed = "windows with " + std::to_string(behind) +
                                   " corners at or behind the eye's plane",
                       .parameter = "their distance behind the eye's plane / units",
                       .unit = "alpha",
                       .naive = "divide every corner by its w",
                       .naive_fails_from = behind == 1 ? std::optional(0.0) : std::nullopt});
    for (const float beyond : {-0.5f, 0.0f, 1e-6f, 0.1f, 1.0f, 100.0f}) {
      TriangleWindows windows{.corners = {{-1.1f, -0.7f, behind == 2 ? beyond : -3.0f},
                                          {1.3f, -0.9f, beyond},
                                          {0.1f, 1.2f, -3}},
                              .sigma = {1},
                              .opacity = {0.9f}};
      const Scene scene = scene_of(white_splats(windows, window_profile()));
      const std::vector<double> expected = alpha_of_oracle(scene, camera);
      double naive = 0;
      int covered = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double alpha = expected[std::size_t(y * width + x)];
          covered += alpha > 0;
          float other = alpha_after_division(windows, camera, x, y);
          if (other < 1 / 255.0f) other = 0;
          naive = worse(naive, std::abs(double(other) - alpha));
        }
      // With two corners behind the eye, W <= 0 and there is no window: w_0 w_1 w_2 times a sum of
      // edges that the triangle inequality bounds.
      if (behind == 1 || beyond < 0)
        EXPECT_GT(covered, 50) << behind << ' ' << beyond;
      else
        EXPECT_EQ(covered, 0) << beyond;
      // A value just below min_alpha may be blended, or not; beside that, roundings of vertices,
      // of the clipper and of the interpolation, relative to windows of tens of pixels.
      const double tolerance = 1e-4;
      const std::vector<glm::vec4> blended = blended_by_device(scene, camera);
      double ours = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        const double off = std::abs(double(blended[i].a) - expected[i]);
        const double larger = std::max(double(blended[i].a), expected[i]);
        if (std::abs(larger - 1 / 255.0) > tolerance) ours = worse(ours, off);
      }
      recorder.add({.at = beyond, .naive = naive, .ours = ours, .tolerance = tolerance});
    }
  }
}

TEST(Numerics, W16_RoundedVerticesDoNotDecideCoverage) {
  Recorder recorder({.stressed = "edges of windows that pass very near to a pixel's centre, sigma "
                                 "0.01",
                     .parameter = "distance of the edge from the centre / pixels",
                     .unit = "alpha",
                     .naive = "rasterise the window itself, with vertices rounded to 1/256 pixel"});
  const Camera camera = straight_camera(width, height, width);
  for (const double distance : {1.8e-3, 1e-3, 5e-4}) {
    TriangleWindows windows;
    std::vector<std::array<glm::dvec2, 3>> corners;
    std::vector<glm::ivec2> pixels;
    Random random(3);
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 8; ++column) {
        // Inside the window, at this distance from its first edge.
        const glm::ivec2 pixel(column * 8 + 4, row * 8 + 4);
        const double angle = random.uniform(0, 2 * M_PI);
        const glm::dvec2 along(std::cos(angle), std::sin(angle)), inwards(-along.y, along.x);
        const glm::dvec2 foot = glm::dvec2(pixel) + 0.5 - distance * inwards;
        const std::array<glm::dvec2, 3> in_image = {foot - random.uniform(1, 2) * along,
                                                    foot + random.uniform(1, 2) * along,
                                                    foot + random.uniform(1, 2) * inwards};
        for (const glm::dvec2& p : in_image)
          windows.corners.emplace_back((p.x - camera.cx) / camera.fx, (camera.cy - p.y) / camera.fy,
                                       -1.0);
        windows.sigma.push_back(0.01f);
        windows.opacity.push_back(0.9f);
        corners.push_back(in_image);
        pixels.push_back(pixel);
      }
    const Scene scene = scene_of(white_splats(windows, window_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const std::vector<glm::vec4> blended = blended_by_device(scene, camera);
    double naive = 0, ours = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::size_t at = std::size_t(pixels[i].y * width + pixels[i].x);
      EXPECT_GT(expected[at], 0.5);
      ours = worse(ours, std::abs(double(blended[at].a) - expected[at]));
      std::array<glm::vec2, 3> snapped;
      for (std::size_t k = 0; k < 3; ++k)
        snapped[k] = glm::vec2(glm::round(corners[i][k] * 256.0) / 256.0);
      const bool covered = rho_in_image(snapped, glm::vec2(pixels[i]) + 0.5f) > 0;
      naive = worse(naive, covered ? 0 : expected[at]);
    }
    // A distance d has the rounding of vertices, and alpha = 0.9 (d / radius)^0.01. Rounding errors
    // of exp2 and log2 are far below 1e-5.
    const double tolerance = 0.9 * 0.01 * vertex_rounding(width) / distance + 1e-5;
    recorder.add({.at = distance, .naive = naive, .ours = ours, .tolerance = tolerance});
  }
}

TEST(Numerics, W15_LargeSigmasAreExact) {
  Recorder recorder(
      {.stressed = "windows with a large sigma", .parameter = "sigma", .unit = "alpha"});
  const Camera camera = straight_camera(width, height, width);
  for (const float sigma : {1.0f, 10.0f, 100.0f, 1000.0f}) {
    const TriangleWindows windows{
        .corners = {{-1.1f, -0.7f, -2.9f}, {1.3f, -0.9f, -3.2f}, {0.1f, 1.2f, -3}},
        .sigma = {sigma},
        .opacity = {0.9f}};
    const Scene scene = scene_of(white_splats(windows, window_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const bool visible =
        std::any_of(expected.begin(), expected.end(), [](double a) { return a > 0; });
    // With 1000, alpha reaches 1/255 only within a tenth of a pixel of the incenter.
    EXPECT_EQ(visible, sigma < 1000);
    // d alpha = sigma d rho, and rho has about ten roundings. 1e-5 for pow.
    recorder.add({.at = sigma,
                  .ours = alpha_error(scene, camera, expected),
                  .tolerance = 10 * epsilon * double(sigma) + 1e-5});
  }
}

}  // namespace splat_windows_test
}  // namespace tureen::test
