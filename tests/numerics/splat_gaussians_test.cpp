// Numerical hazards of Gaussians: covariances of needles, discs seen edge-on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/numerics/splat_scenes.hpp"

namespace tureen::test {
namespace splat_gaussians_test {

constexpr int width = 64, height = 48;

/// A Gaussian of opacity 0.9 on the axis of straight_camera().
Gaussians gaussian_at(double depth, const glm::dvec3& scales, const glm::dquat& rotation) {
  return {.centers = {glm::vec3(0, 0, float(-depth))},
          .scales = {glm::vec3(scales)},
          .rotations = {glm::quat(rotation)},
          .opacity = {0.9f}};
}

TEST(Numerics, E1_NeedlesKeepTheirWidth) {
  Recorder recorder({.stressed = "Gaussians that are one pixel wide and long, without a low pass",
                     .parameter = "length / width",
                     .unit = "alpha",
                     .naive = "invert the covariance in floats, with a c - b^2",
                     .naive_fails_from = 1e4});
  const Camera camera = straight_camera(width, height, width);
  SplatProfile profile = *profile_named("3dgs");
  profile.low_pass = SplatProfile::LowPass::none;
  for (const double aspect : {10.0, 100.0, 1e3, 1e4}) {
    double naive = 0, ours = 0;
    for (const double angle : {0.3, 0.7, 1.9, 2.6}) {
      const double pixel = 5.0 / width;
      const glm::dquat turn(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
      const Gaussians gaussians = gaussian_at(5, {pixel * aspect, pixel, pixel}, turn);
      const Scene scene = scene_of(white_splats(gaussians, profile));
      const std::vector<double> expected = alpha_of_oracle(scene, camera);
      ours = worse(ours, alpha_error(scene, camera, expected));

      const glm::mat3 rotation = glm::mat3_cast(gaussians.rotations[0]);
      const glm::vec3 scales = gaussians.scales[0];
      const float to_pixels = float(width) / 5.0f;
      const auto row = [&](int i) {
        return to_pixels * glm::vec3(rotation[0][i], rotation[1][i], rotation[2][i]) * scales;
      };
      const glm::vec3 x = row(0), y = row(1);
      const float a = glm::dot(x, x), b = glm::dot(x, y), c = glm::dot(y, y);
      const float determinant = a * c - b * b;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
          const float dx = float(u) + 0.5f - float(camera.cx);
          const float dy = float(camera.cy) - float(v) - 0.5f;
          const float q = (c * dx * dx - 2 * b * dx * dy + a * dy * dy) / determinant;
          // The forms of the published rasterisers: alpha 0 for a negative q.
          float alpha = q >= 0 ? std::min(0.99f, 0.9f * std::exp(-0.5f * q)) : 0.0f;
          if (alpha < profile.min_alpha) alpha = 0;
          naive = worse(naive, std::abs(double(alpha) - expected[std::size_t(v * width + u)]));
        }
    }
    // The variance across the needle has an error of `aspect` times the roundings of two rows: the
    // product of the rows' lengths over their cross product is about the aspect. A relative error
    // of q changes alpha by at most 0.37 of it. 2e-5 for exp.
    const double tolerance = 16 * epsilon * aspect + 2e-5;
    recorder.add({.at = aspect, .naive = naive, .ours = ours, .tolerance = tolerance});
  }
}

TEST(Numerics, F11_DiscsSeenEdgeOnStayVisible) {
  Recorder recorder({.stressed = "a disc of 2DGS that turns through its edge",
                     .parameter = "degrees beyond edge-on",
                     .unit = "alpha",
                     .naive = "intersect the ray with the plane in floats, without the screen's "
                              "filter"});
  const Camera camera = straight_camera(width, height, width);
  for (const double degrees : {-1.0, -0.01, 0.0, 1e-4, 0.01, 1.0, 30.0}) {
    const double angle = M_PI / 2 - degrees * M_PI / 180;
    const glm::dquat turn(std::cos(angle / 2), std::sin(angle / 2), 0, 0);
    Gaussians discs = gaussian_at(5, {0.5, 0.4, 0}, turn);
    discs.flat = true;
    const Scene scene = scene_of(white_splats(discs, *profile_named("2dgs")));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const glm::mat3 rotation = glm::mat3_cast(discs.rotations[0]);
    double naive = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::vec3 ray(ray_of_pixel(camera, x, y)), center = discs.centers[0];
        const float t = glm::dot(center, rotation[2]) / glm::dot(ray, rotation[2]);
        const glm::vec3 hit = t * ray - center;
        const float u = glm::dot(hit, rotation[0]) / 0.5f, v = glm::dot(hit, rotation[1]) / 0.4f;
        float alpha = 0.9f * std::exp(-0.5f * (u * u + v * v));
        if (alpha < 1 / 255.0f) alpha = 0;
        naive = worse(naive, std::abs(double(alpha) - expected[std::size_t(y * width + x)]));
      }
    // The error of q in a few roundings of a cross product whose terms are up to 64 times larger
    // than it; near edge-on, the screen's filter is the smaller q.
    recorder.add({.at = degrees,
                  .naive = naive,
                  .ours = alpha_error(scene, camera, expected),
                  .tolerance = 1e-5});
  }
}

}  // namespace splat_gaussians_test
}  // namespace tureen::test
