// Numerical hazards of the projection of Gaussians: centres near the eye's plane, sizes far above
// and below a pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/numerics/splat_tiles.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace splat_projection_test {

constexpr int width = 64, height = 48;

/// A ball of opacity 0.9.
Scene ball(const glm::dvec3& center, double scale, const SplatProfile& profile,
           float opacity = 0.9f) {
  return scene_of(white_splats(Gaussians{.centers = {glm::vec3(center)},
                                         .scales = {glm::vec3(float(scale))},
                                         .rotations = {glm::quat(1, 0, 0, 0)},
                                         .opacity = {opacity}},
                               profile));
}

/// The profile 3dgs, also for centres beside the eye.
SplatProfile profile_without_limit() {
  SplatProfile profile = *profile_named("3dgs");
  profile.min_center_depth = 0;
  return profile;
}

/// Errors of alpha by the covariance of a ball in floats, with its determinant a c - b^2.
double error_of_covariance(const Camera& camera, const glm::vec3& center, float scale,
                           const std::vector<double>& expected) {
  const float depth = -center.z;
  const glm::vec2 focal(camera.fx, camera.fy);
  const glm::vec2 limit = 0.65f * glm::vec2(width, height) / focal;
  const glm::vec2 slope = glm::clamp(glm::vec2(center.x, center.y) / depth, -limit, limit);
  const glm::vec2 size = scale * focal / depth;
  const float a = size.x * size.x * (1 + slope.x * slope.x) + 0.3f;
  const float b = size.x * size.y * slope.x * slope.y;
  const float c = size.y * size.y * (1 + slope.y * slope.y) + 0.3f;
  const float determinant = a * c - b * b;
  double error = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float dx = float(x) + 0.5f - float(camera.cx) - focal.x * center.x / depth;
      const float dy = float(camera.cy) - float(y) - 0.5f - focal.y * center.y / depth;
      const float q = (c * dx * dx - 2 * b * dx * dy + a * dy * dy) / determinant;
      const float alpha = 0.9f * std::exp(-0.5f * q);
      error = worse(error, std::abs(double(alpha) - expected[std::size_t(y * width + x)]));
    }
  return error;
}

TEST(Numerics, E2_CentersBesideTheEyeKeepTheirAlpha) {
  Recorder recorder({.stressed = "a Gaussian beside the eye, x / z up to 1e8, device and tiles",
                     .parameter = "depth of the centre / units",
                     .unit = "alpha",
                     .naive = "invert the covariance in floats, with a c - b^2"});
  const Camera camera = straight_camera(width, height, 1000);
  for (const double depth : {1.0, 1e-2, 1e-4, 1e-6, 1e-8}) {
    const glm::dvec3 center(1, 0.3, -depth);
    const Scene scene = ball(center, 0.5, profile_without_limit());
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    EXPECT_GT(expected[0], 0.05);
    // The centre is 2.1 standard deviations away: q = 4.4, and alpha = 0.1 changes by half of q's
    // relative error, ten roundings. 2e-6 for exp.
    recorder.add({.at = depth,
                  .naive = error_of_covariance(camera, center, 0.5f, expected),
                  .ours = alpha_error_of_both(scene, camera, expected),
                  .tolerance = 0.1 * 0.5 * 4.4 * 10 * epsilon + 2e-6});
  }
}

TEST(Numerics, E3_GaussiansLargerThanTheImage) {
  Recorder recorder({.stressed = "a Gaussian whose centre is one standard deviation outside the "
                                 "image, device and tiles",
                     .parameter = "standard deviation / pixels",
                     .unit = "alpha",
                     .naive = "the radius as an integer of 32 bits",
                     .naive_fails_from = 1e10,
                     .naive_holds_below = 1e6});
  const Camera camera = straight_camera(width, height, width);
  for (const double pixels : {1e2, 1e3, 1e5, 1e8, 1e10}) {
    const double scale = pixels * 5 / width;
    const Scene scene = ball({scale, -scale, -5}, scale, *profile_named("3dgs"));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    double ours = alpha_error_of_both(scene, camera, expected);
    const RenderOptions published{.plan = {.as_published = true}};
    const std::vector<glm::vec4> with_tiles = blended_by_device(scene, camera, published);
    for (std::size_t i = 0; i < expected.size(); ++i)
      ours = worse(ours, std::abs(double(with_tiles[i].a) - expected[i]));
    // Such a radius converts to the smallest integer on x86: no tile is near the centre.
    const double naive = 3 * pixels < 0x1p31 ? 0 : expected[0];
    // q is at most 3, and alpha 0.9; q has about ten roundings. 2e-6 for exp.
    recorder.add({.at = pixels,
                  .naive = naive,
                  .ours = ours,
                  .tolerance = 0.9 * 0.5 * 3 * 10 * epsilon + 2e-6});
  }
}

TEST(Numerics, E4_SmallGaussiansKeepTheirEnergy) {
  Recorder recorder({.stressed = "a Gaussian that recedes, profile mip, device and tiles",
                     .parameter = "standard deviation / pixels",
                     .unit = "relative error of the sum of alpha",
                     .naive = "dilation without compensation (profile 3dgs)",
                     .naive_fails_from = -1});
  const Camera camera = straight_camera(width, height, width);
  for (const double pixels : {2.0, 1.0, 0.3, 0.1, 0.01}) {
    const double depth = 1 / pixels;
    const auto error = [&](const char* name, double expected, const auto& draw) {
      SplatProfile profile = *profile_named(name);
      profile.min_alpha = 1e-6f;
      const Scene scene = ball({0, 0, -depth}, 1.0 / width, profile, 0.5f);
      double sum = 0;
      for (const glm::vec4& pixel : draw(scene)) sum += double(pixel.a);
      return std::abs(sum / expected - 1);
    };
    const auto device = [&](const Scene& scene) { return blended_by_device(scene, camera); };
    const auto tiles = [&](const Scene& scene) { return blended_by_tiles(scene, camera); };
    const double integral = 0.5 * 2 * M_PI * pixels * pixels;
    // A sum over pixels is the integral, but for 2 exp(-2 pi^2 0.3) = 0.54 % along each axis. The
    // part of the integral where alpha is below min_alpha is min_alpha over the largest alpha.
    const double largest = 0.5 * pixels * pixels / (pixels * pixels + dilation_variance);
    recorder.add({.at = pixels,
                  .naive = error("3dgs", integral, device),
                  .ours = worse(error("mip", integral, device), error("mip", integral, tiles)),
                  .tolerance = 0.0108 + 1e-6 / largest});
    // The authors' formula for 3dgs stays: its energy is that of the dilated Gaussian.
    EXPECT_LT(error("3dgs", integral + 0.5 * 2 * M_PI * dilation_variance, device), 0.0108);
  }
}

TEST(Numerics, E5_ScalesWhoseSquaresUnderflow) {
  Recorder recorder({.stressed = "discs of 2DGS and Gaussians of 3DGS with tiny scales, device and "
                                 "tiles",
                     .parameter = "scale / units",
                     .unit = "alpha",
                     .naive = "the smaller of the plane's and the screen's q, by min"});
  const Camera camera = straight_camera(width, height, width);
  for (const double scale : {1e-2, 1e-10, 1e-20, 1e-30, 1e-38, 0.0}) {
    const glm::dvec3 center(0.3, -0.2, -5);
    Gaussians disc{.centers = {glm::vec3(center)},
                   .scales = {glm::vec3(float(scale))},
                   .rotations = {glm::quat(glm::normalize(glm::dquat(1, 0.2, -0.3, 0.1)))},
                   .opacity = {0.9f},
                   .flat = true};
    double ours = 0, naive = 0;
    for (const char* name : {"2dgs", "3dgs"}) {
      const Scene scene = scene_of(white_splats(disc, *profile_named(name)));
      const std::vector<double> expected = alpha_of_oracle(scene, camera);
      EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.3);
      ours = worse(ours, alpha_error_of_both(scene, camera, expected));
    }
    const glm::mat3 axes = glm::mat3_cast(disc.rotations[0]);
    const glm::vec3 u = float(scale) * axes[0], v = float(scale) * axes[1], c = disc.centers[0];
    const glm::vec3 ray(ray_of_pixel(camera, width / 2, height / 2));
    const glm::vec3 k(u.x + ray.x * u.z, v.x + ray.x * v.z, c.x + ray.x * c.z);
    const glm::vec3 l(u.y + ray.y * u.z, v.y + ray.y * v.z, c.y + ray.y * c.z);
    const glm::vec3 point = glm::cross(k, l);
    const glm::vec2 uv = glm::vec2(point.x, point.y) / point.z;
    // std::min(q, ..) and min() of GLSL may return a q that is not a number.
    if (std::isnan(glm::dot(uv, uv))) naive = NAN;
    // The offset from the centre has the roundings of an image coordinate of up to 64 pixels; q
    // changes by at most 1.3 of its square root / 0.5 px^2. 2e-6 for exp.
    recorder.add({.at = scale,
                  .naive = worse(naive, 0),
                  .ours = ours,
                  .tolerance = 2 * 1.3 * vertex_rounding(width) + 2e-6});
  }
}

/// The splats with all lengths times `unit`, and no rule for near centres.
Splats in_unit(Splats splats, double unit) {
  for_each_column(splats.kernel, [&](const auto& column) {
    if (column.role == ColumnRole::position || column.role == ColumnRole::corner ||
        column.role == ColumnRole::scale)
      for (auto& each : column.values) each *= float(unit);
  });
  splats.profile.min_center_depth *= float(unit);
  return splats;
}

/// Whether a range of an ellipse's image by squares of squares of lengths in floats is right: a
/// ball of radius 0.3 at distance 3.
bool is_range_right(double unit) {
  const auto depth = float(3 * unit), radius = float(0.3 * unit), along = 50 * radius;
  const float a = radius * radius - depth * depth, b = along * radius;
  const float range = (b + std::sqrt(b * b - a * (along * along))) / a;
  return std::abs(double(range) + 50 * 0.3 / 3 * (0.1 + 1) / (1 - 0.01)) < 1;
}

TEST(Numerics, E8_AnyUnitOfLength) {
  Recorder recorder({.stressed =
                         "sixty splats of each kernel and profile in another unit of length, "
                         "device and tiles",
                     .parameter = "size of the scene / units",
                     .unit = "alpha",
                     .naive = "borders of images by squares of squares of lengths"});
  for (const double unit : {1e-12, 1.0, 1e10, 1e15}) {
    double ours = 0;
    for (const SplatKind& kind : splat_kinds) {
      // The same shaders as 3DGS.
      if (kind.name == std::string("flat_games") || kind.name == std::string("gaussians_mip"))
        continue;
      const Scene scene = scene_of(in_unit(random_splats(kind, 60, 0.3, 5), unit));
      const Camera camera =
          look_at(unit * glm::dvec3(1, 2, -2), glm::dvec3(0), {0, 1, 0}, 0.8, 24, 18);
      const std::vector<double> expected = alpha_of_oracle(scene, camera);
      EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.9) << kind.name;
      ours = worse(ours, alpha_error_of_both(scene, camera, expected));
    }
    // By rounding, a splat may be blended or not where its alpha is min_alpha.
    recorder.add({.at = unit,
                  .naive = is_range_right(unit) ? 0.0 : 1.0,
                  .ours = ours,
                  .tolerance = 1.0 / 255});
  }
}

}  // namespace splat_projection_test
}  // namespace tureen::test
