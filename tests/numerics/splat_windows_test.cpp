// Numerical hazards of triangle windows: division by a small w, rounded vertices, extreme sigmas.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "tests/numerics/splat_tiles.hpp"
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
                                   " corners at or behind the eye's plane, device and tiles",
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
      double ours = 0;
      for (const auto& blended :
           {blended_by_device(scene, camera), blended_by_tiles(scene, camera)})
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
                                 "0.01, device and tiles",
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
    const std::vector<glm::vec4> device = blended_by_device(scene, camera),
                                 tiles = blended_by_tiles(scene, camera);
    double naive = 0, ours = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::size_t at = std::size_t(pixels[i].y * width + pixels[i].x);
      EXPECT_GT(expected[at], 0.5);
      for (const auto* blended : {&device, &tiles})
        ours = worse(ours, std::abs(double((*blended)[at].a) - expected[at]));
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
  Recorder recorder({.stressed = "windows with a large sigma, device and tiles",
                     .parameter = "sigma",
                     .unit = "alpha"});
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
                  .ours = alpha_error_of_both(scene, camera, expected),
                  .tolerance = 10 * epsilon * double(sigma) + 1e-5});
  }
}

/// One window in the middle of the image.
TriangleWindows middle_window(float sigma, float opacity) {
  return {.corners = {{-1.1f, -0.7f, -2.9f}, {1.3f, -0.9f, -3.2f}, {0.1f, 1.2f, -3}},
          .sigma = {sigma},
          .opacity = {opacity}};
}

/// Only with the centre well before the eye.
SplatProfile published_profile() { return *profile_named("triangle-splatting"); }

TEST(Numerics, W1_TheSmallestSigmasAreSteps) {
  Recorder recorder({.stressed = "windows whose sigma approaches 0, device and tiles",
                     .parameter = "sigma",
                     .unit = "alpha",
                     .naive = "limit rho to at least 1e-6, as for gradients"});
  const Camera camera = straight_camera(width, height, width);
  for (const float sigma : {0.1f, 0.01f, 1e-3f, 1e-6f, 1e-20f, 1e-38f, 1e-45f}) {
    const TriangleWindows window = middle_window(sigma, 0.9f);
    const Scene scene = scene_of(white_splats(window, published_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    // Outside, rho is 0.
    EXPECT_EQ(expected[0], 0);
    const double outside = double(0.9f) * std::pow(1e-6, double(sigma));
    // d alpha = alpha sigma d(distance) / distance. No edge passes a pixel's centre within a
    // thousandth of a pixel. 1e-5 for pow.
    recorder.add({.at = double(sigma),
                  .naive = outside,
                  .ours = alpha_error_of_both(scene, camera, expected),
                  .tolerance = double(sigma) * vertex_rounding(width) / 1e-3 + 1e-5});
  }
}

TEST(Numerics, W2_FaintWindowsAreNotDrawn) {
  Recorder recorder(
      {.stressed = "windows with an opacity around min_alpha (W3), sigma 0.01 to 1e4, "
                   "device and tiles",
       .parameter = "opacity / min_alpha",
       .unit = "alpha",
       .naive = "the triangle, shrunk by 1 - (min_alpha / opacity)^(1 / sigma), which "
                "is negative for faint ones, without a test of alpha"});
  const Camera camera = straight_camera(width, height, width);
  const SplatProfile profile = published_profile();
  std::vector<double> rhos =
      alpha_of_oracle(scene_of(white_splats(middle_window(1, 0.9f), profile)), camera);
  for (double& rho : rhos) rho /= double(0.9f);
  const double largest_rho = *std::max_element(rhos.begin(), rhos.end());
  for (const double factor : {0.0, 0.5, 0.999, 1.001, 2.0, 200.0}) {
    const auto opacity = float(factor * double(profile.min_alpha));
    double ours = 0, naive = 0;
    for (const float sigma : {0.01f, 1.0f, 100.0f, 1e4f}) {
      const Scene scene = scene_of(white_splats(middle_window(sigma, opacity), profile));
      const std::vector<double> expected = alpha_of_oracle(scene, camera);
      const double most = *std::max_element(expected.begin(), expected.end());
      EXPECT_EQ(most > 0, factor * std::pow(largest_rho, double(sigma)) > 1) << sigma;
      ours = worse(ours, alpha_error_of_both(scene, camera, expected));
      const double shrunk = std::abs(1 - std::pow(1 / factor, 1 / double(sigma)));
      for (std::size_t i = 0; i < rhos.size(); ++i) {
        const bool covered = rhos[i] > 0 && rhos[i] >= 1 - shrunk;
        const double alpha = covered ? double(opacity) * std::pow(rhos[i], double(sigma)) : 0;
        naive = worse(naive, std::abs(alpha - expected[i]));
      }
    }
    // As in W15, for the largest sigma that is visible with this opacity; 1e-5 for pow.
    recorder.add(
        {.at = factor, .naive = naive, .ours = ours, .tolerance = 10 * epsilon * 100 + 1e-5});
  }
}

/// rho in floats by lines n . p + d, whose origin is this far from the image.
float rho_by_lines(const std::array<glm::dvec2, 3>& corners, const glm::dvec2& pixel,
                   const glm::dvec2& origin) {
  std::array<glm::vec2, 3> at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = glm::vec2(corners[k] + origin);
  const glm::vec2 p(pixel + origin);
  const auto cross = [](const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; };
  float perimeter = 0, doubled_area = 0, nearest = 3e38f;
  for (std::size_t k = 0; k < 3; ++k) doubled_area += cross(at[k], at[(k + 1) % 3]);
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec2 edge = at[(k + 1) % 3] - at[k];
    const float length = glm::length(edge), sign = doubled_area < 0 ? -1.0f : 1.0f;
    const glm::vec2 normal = sign * glm::vec2(-edge.y, edge.x) / length;
    perimeter += length;
    nearest = std::min(nearest, glm::dot(normal, p) - glm::dot(normal, at[k]));
  }
  return std::clamp(nearest / (std::abs(doubled_area) / perimeter), 0.0f, 1.0f);
}

TEST(Numerics, W13_ShortEdges) {
  Recorder recorder(
      {.stressed = "windows with one short edge, 40 pixels long, device and tiles",
       .parameter = "length / width",
       .unit = "alpha",
       .naive = "distances n . p + d in floats, 4,000 pixels from the image's corner"});
  const Camera camera = straight_camera(width, height, width);
  for (const double aspect : {1.0, 100.0, 1e3, 1e4}) {
    double ours = 0, naive = 0;
    for (const glm::dvec2 slope : {glm::dvec2(2, 1), glm::dvec2(1, -1), glm::dvec2(1, 3)}) {
      // The axis passes through the centres of pixels.
      const double pixel = 3.0 / width, length = 40 * pixel;
      const glm::dvec3 along(glm::normalize(slope), 0), across(-along.y, along.x, 0.2);
      const glm::dvec3 middle = 3.0 * ray_of_pixel(camera, width / 2, height / 2);
      const glm::dvec3 tip = middle - 0.5 * length * along;
      const glm::dvec3 end = tip + length * along, half = 0.5 * length / aspect * across;
      const TriangleWindows window{
          .corners = {glm::vec3(tip), glm::vec3(end - half), glm::vec3(end + half)},
          .sigma = {1},
          .opacity = {0.9f}};
      const Scene scene = scene_of(white_splats(window, published_profile()));
      const std::vector<double> expected = alpha_of_oracle(scene, camera);
      EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](double a) { return a > 0.1; }),
                5);
      ours = worse(ours, alpha_error_of_both(scene, camera, expected));
      std::array<glm::dvec2, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 p(window.corners[k]);
        corners[k] = {camera.cx - camera.fx * p.x / p.z, camera.cy + camera.fy * p.y / p.z};
      }
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          float alpha = 0.9f * rho_by_lines(corners, {x + 0.5, y + 0.5}, {4000, 2000});
          if (alpha < published_profile().min_alpha) alpha = 0;
          naive = worse(naive, std::abs(double(alpha) - expected[std::size_t(y * width + x)]));
        }
    }
    // Vertices are rounded, relative to an inradius of half the width; 1e-6 for pow.
    const double inradius = 0.5 * 40 / aspect;
    recorder.add({.at = aspect,
                  .naive = naive,
                  .ours = ours,
                  .tolerance = 0.9 * vertex_rounding(width) / inradius + 1e-6});
  }
}

/// rho in floats by homogeneous points; the line of each edge starts at its first end.
float rho_from_first_ends(const TriangleWindows& windows, const Camera& camera, int x, int y) {
  std::array<glm::vec3, 3> points, normals;
  for (std::size_t k = 0; k < 3; ++k)
    points[k] = windows.corners[k] * glm::vec3(camera.fx, -camera.fy, -1);
  float weight = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3 &from = points[(k + 1) % 3], &to = points[(k + 2) % 3];
    normals[k] = glm::cross(from, to - from);
    weight += points[k].z * glm::length(glm::vec2(normals[k]));
  }
  const float determinant = glm::dot(points[0], normals[0]);
  const glm::vec3 pixel(float(x) + 0.5f - float(camera.cx), float(y) + 0.5f - float(camera.cy), 1);
  float rho = 1;
  for (const glm::vec3& n : normals)
    rho = std::min(rho, weight * glm::dot(n, pixel) / (determinant * glm::length(glm::vec2(n))));
  return std::max(rho, 0.0f);
}

TEST(Numerics, W13b_OneCornerFarAway) {
  Recorder recorder({.stressed = "windows with two near corners and one far away, device and tiles",
                     .parameter = "distance / units",
                     .unit = "alpha",
                     .naive = "the line of each edge starts at its first end",
                     .naive_fails_from = 1e6});
  const Camera camera = straight_camera(width, height, width);
  for (const double distance : {5.0, 1e2, 1e4, 1e6, 1e7}) {
    const TriangleWindows window{.corners = {{-0.9f, -0.7f, -3},
                                             {1.1f, -0.5f, -3.2f},
                                             glm::vec3(distance * glm::dvec3(0.1, 0.25, -1))},
                                 .sigma = {1},
                                 .opacity = {0.9f}};
    const Scene scene = scene_of(white_splats(window, published_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](double a) { return a > 0.1; }),
              100);
    double naive = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        float alpha = 0.9f * rho_from_first_ends(window, camera, x, y);
        if (alpha < 1 / 255.0f) alpha = 0;
        naive = worse(naive, std::abs(double(alpha) - expected[std::size_t(y * width + x)]));
      }
    // Over the inradius of about ten pixels, alpha changes by a tenth a pixel. The far corner's
    // rounding is relative to its distance, and moves what is interpolated between it and corners
    // at a distance of 3. 1e-5 for pow.
    recorder.add({.at = distance,
                  .naive = naive,
                  .ours = alpha_error_of_both(scene, camera, expected),
                  .tolerance = 1e-5 + 0.1 * epsilon * distance});
  }
}

TEST(Numerics, W17_WindowsFarLargerThanTheImage) {
  Recorder recorder({.stressed =
                         "windows with an edge through the image and corners far outside it, "
                         "device and tiles",
                     .parameter = "size / pixels",
                     .unit = "pixels, of the distance from the edge",
                     .naive = "vertices of 16 bits and 8 binary digits, limited to 32,767 pixels",
                     .naive_fails_from = 1e5});
  const Camera camera = straight_camera(width, height, width);
  constexpr float sigma = 0.1f, opacity = 0.9f;
  for (const double size : {1e3, 1.6e4, 1e5, 1e6}) {
    double ours = 0, naive = 0;
    for (const double angle : {0.2, 1.3, 2.9}) {
      const glm::dvec2 inwards(std::cos(angle), std::sin(angle)), along(-inwards.y, inwards.x);
      TriangleWindows window{.corners = {}, .sigma = {sigma}, .opacity = {opacity}};
      std::array<glm::dvec2, 3> limited;
      const std::array<glm::dvec2, 3> in_image{-size * along, 0.7 * size * along,
                                               0.9 * size * inwards};
      double perimeter = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        window.corners.emplace_back(3.0 / width * in_image[k], -3);
        limited[k] = glm::round(256.0 * glm::clamp(in_image[k], -32767.0, 32767.0)) / 256.0;
        perimeter += glm::length(in_image[(k + 1) % 3] - in_image[k]);
      }
      const double inradius = 1.7 * 0.9 * size * size / perimeter;
      const auto distance = [&](double alpha) {
        return std::pow(alpha / double(opacity), 1 / double(sigma)) * inradius;
      };
      const Scene scene = scene_of(white_splats(window, published_profile()));
      const std::vector<double> expected = alpha_of_oracle(scene, camera);
      const std::vector<glm::vec4> device = blended_by_device(scene, camera),
                                   tiles = blended_by_tiles(scene, camera);
      const glm::dvec2 edge = glm::normalize(limited[1] - limited[0]);
      int covered = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const std::size_t i = std::size_t(y * width + x);
          const double truth = distance(expected[i]);
          covered += truth > 0;
          for (const auto* blended : {&device, &tiles})
            ours = worse(ours, std::abs(distance(double((*blended)[i].a)) - truth));
          const glm::dvec2 from(x + 0.5 - camera.cx - limited[0].x,
                                camera.cy - y - 0.5 - limited[0].y);
          const double clamped = edge.y * from.x - edge.x * from.y;
          naive = worse(naive, std::abs(std::max(clamped, 0.0) - truth));
        }
      EXPECT_GT(covered, 1000);
      EXPECT_LT(covered, 2100);
    }
    // Vertices are rounded relative to their distance from the eye's axis. A power of 10 has ten
    // times the rounding of alpha and the error of pow, relative to 40 pixels.
    recorder.add({.at = size,
                  .naive = naive,
                  .ours = ours,
                  .tolerance = vertex_rounding(size) + 40 * 10 * (2 * epsilon + 1e-6)});
  }
}

}  // namespace splat_windows_test
}  // namespace tureen::test
