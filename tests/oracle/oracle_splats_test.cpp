// How the oracle blends splats: order, the end of a pixel, samples, and values at their limits.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/oracle.hpp"
#include "tests/oracle/splats_in_view.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace oracle_splats_test {

const glm::vec3 red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1);

struct Disc {
  glm::vec3 center, color;
  float opacity = 0.5f;
  double turn = 0;  // radians about the y axis; 0: faces the camera
};

/// Discs with the same alpha everywhere: their size is 1e4, so that it changes by less than 1e-6.
Splats discs_of(const std::vector<Disc>& discs, float stop_transmittance = 0) {
  Gaussians gaussians;
  gaussians.flat = true;
  std::vector<glm::vec3> colors;
  for (const Disc& disc : discs) {
    gaussians.centers.push_back(disc.center);
    gaussians.scales.emplace_back(1e4f);
    gaussians.rotations.emplace_back(std::cos(disc.turn / 2), 0, std::sin(disc.turn / 2), 0);
    gaussians.opacity.push_back(disc.opacity);
    colors.push_back(disc.color);
  }
  Splats splats{.kernel = std::move(gaussians),
                .color = flat_colors(colors),
                .profile = *profile_named("redisplats")};
  splats.profile.stop_transmittance = stop_transmittance;
  return splats;
}

void expect_color(const glm::vec4& pixel, const glm::dvec4& expected, const char* where) {
  // Colours are stored as float coefficients, and the result is of floats.
  for (int channel = 0; channel < 4; ++channel)
    EXPECT_NEAR(pixel[channel], expected[channel], 2e-6) << where << ", channel " << channel;
}

/// Two planes that cross the axis at depths 5 and 5.2, turned by 45 degrees to both sides. At the
/// image point x the first has the depth 5 / (1 + u), the second 5.2 / (1 - u), u = (x - cx) / fx.
TEST(OracleSplats, ExactOrderFollowsTheRayWhereDiscsCross) {
  const Scene scene = scene_of(
      discs_of({{{0, 0, -5}, red, 0.5f, -M_PI / 4}, {{0, 0, -5.2f}, blue, 0.5f, M_PI / 4}}));
  const Camera camera = straight_camera(41, 5, 41);
  OracleOptions options{.background = std::nullopt};
  const ImageF by_center = render_oracle(scene, {camera}, options).color;
  options.splat_order = oracle::SplatOrder::exact;
  const ImageF exact = render_oracle(scene, {camera}, options).color;
  int turned = 0;
  for (int x = 0; x < camera.width; ++x) {
    SCOPED_TRACE(x);
    const double u = (x + 0.5 - camera.cx) / camera.fx;
    const bool red_first = 5 / (1 + u) < 5.2 / (1 - u);
    turned += !red_first;
    // Alpha is 1 - 0.5^2; the colour is that of the covered part.
    const glm::dvec4 first(2 / 3.0, 0, 1 / 3.0, 0.75), second(1 / 3.0, 0, 2 / 3.0, 0.75);
    expect_color(by_center.at(x, 2), first, "by centre");
    expect_color(exact.at(x, 2), red_first ? first : second, "exact");
  }
  EXPECT_GT(turned, 15);
  EXPECT_LT(turned, 25);
}

/// A splat ends the pixel by the rule of its own layer, for the splats of all layers.
TEST(OracleSplats, TheStopRuleIsThatOfTheSplatsOwnLayer) {
  Scene scene;
  scene.layers.push_back(layer_of(discs_of(
      {{{0, 0, -1}, red, 0.8f}, {{0, 0, -3}, blue, 0.5f}, {{0, 0, -6}, red, 0.5f}}, 0.015f)));
  scene.layers.push_back(
      layer_of(discs_of({{{0, 0, -2}, green, 0.9f}, {{0, 0, -4}, green, 0.5f}}, 0)));
  const Camera camera = straight_camera(3, 3, 3);
  OracleOptions options;
  // 0.8 leaves 0.2, the second layer's 0.9 leaves 0.02; 0.5 would leave 0.01, which is below 0.015.
  expect_color(render_oracle(scene, {camera}, options).color.at(1, 1), {0.8, 0.18, 0, 1}, "stop");
  options.splat_stop = false;
  expect_color(render_oracle(scene, {camera}, options).color.at(1, 1),
               {0.8 + 0.0025, 0.18 + 0.005, 0.01, 1}, "no stop");
}

TEST(OracleSplats, SupersamplingAveragesAFinerImage) {
  const Scene scene = scene_of(random_splats(splat_kinds[5], 200, 0.3, 3));
  const Camera camera = camera_of_ball(3, 32, 24);
  const OracleImage mean = render_oracle(scene, {camera}, {.supersampling = 3});
  const OracleImage fine = render_oracle(scene, {resampled(camera, 96, 72)});
  ASSERT_EQ(mean.splat_alpha.size(), fine.splat_alpha.size());
  for (std::size_t i = 0; i < fine.splat_alpha.size(); ++i)
    ASSERT_NEAR(mean.splat_alpha[i], fine.splat_alpha[i], 1e-12);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      // The mean of colours above 1 is clamped, so these pixels are left out.
      glm::dvec3 sum(0);
      bool clamped = false;
      for (int i = 0; i < 9; ++i) {
        const glm::vec4& sample = fine.color.at(3 * x + i % 3, 3 * y + i / 3);
        sum += glm::dvec3(sample) / 9.0;
        clamped = clamped || std::max({sample.r, sample.g, sample.b}) >= 1;
      }
      if (clamped) continue;
      for (int channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(mean.color.at(x, y)[channel], sum[channel], 1e-6) << x << ", " << y;
    }
}

/// A point with the low pass of 3DGS has the integral opacity * 2 pi * 0.3 px^2, whatever the
/// number of samples.
TEST(OracleSplats, LowPassesAreInPixelsWhateverTheNumberOfSamples) {
  Splats splats{.kernel = Gaussians{.centers = {{0, 0, -1}},
                                    .scales = {glm::vec3(1e-9f)},
                                    .rotations = {glm::quat(1, 0, 0, 0)},
                                    .opacity = {0.9f}},
                .color = flat_colors({red}),
                .profile = *profile_named("3dgs")};
  splats.profile.min_alpha = 1e-6f;
  const Scene scene = scene_of(std::move(splats));
  const Camera camera = straight_camera(17, 17, 100);
  for (const int samples : {2, 4, 8}) {
    const OracleImage image = render_oracle(scene, {camera}, {.supersampling = samples});
    double sum = 0;
    for (const double alpha : image.splat_alpha) sum += alpha / (samples * samples);
    // The sum over a grid of half a deviation differs from the integral by far less.
    EXPECT_NEAR(sum, 0.9 * 2 * M_PI * dilation_variance, 1e-3) << samples;
  }
}

/// Samples with different coverage: the colour is premultiplied before the mean, and divided by the
/// mean coverage after it.
TEST(OracleSplats, OnATransparentBackgroundTheColourIsThatOfTheCoveredPart) {
  Scene scene = scene_of(discs_of({{{0, 0, -2}, {0.8f, 0.4f, 0}, 0.25f}}));
  const Camera camera = straight_camera(3, 3, 3);
  OracleOptions options{.supersampling = 2, .background = std::nullopt};
  expect_color(render_oracle(scene, {camera}, options).color.at(1, 1), {0.8, 0.4, 0, 0.25}, "disc");
  // An opaque blue triangle behind it, over the right half of the middle pixel.
  TriangleSoup half;
  half.positions = {{0, -9, -3}, {9, -9, -3}, {0, 9, -3}};
  half.triangles = {{0, 1, 2}};
  half.appearance = FaceColors{{glm::vec4(blue, 1)}};
  scene.layers.push_back(layer_of(std::move(half)));
  // Coverage (0.25 + 1) / 2, colour (0.25 c + (0.25 c + 0.75 blue)) / 2.
  expect_color(render_oracle(scene, {camera}, options).color.at(1, 1),
               {0.2 / 0.625, 0.1 / 0.625, 0.375 / 0.625, 0.625}, "before a triangle");
}

TEST(OracleSplats, ValuesAtTheirLimitsGiveFiniteImages) {
  for (const SplatKind& kind : splat_kinds) {
    const Splats splats = hostile_splats(kind);
    ASSERT_EQ(defect(splats), std::nullopt) << kind.name;
    const Scene scene = scene_of(splats);
    for (const oracle::SplatOrder order : {oracle::SplatOrder::center, oracle::SplatOrder::exact})
      for (const double distance : {3.0, 0.1}) {
        const OracleImage image =
            render_oracle(scene, {camera_of_ball(distance, 24, 18)}, {.splat_order = order});
        for (std::size_t i = 0; i < image.splat_alpha.size(); ++i) {
          ASSERT_GE(image.splat_alpha[i], 0) << kind.name << ' ' << i;
          ASSERT_LE(image.splat_alpha[i], 1) << kind.name << ' ' << i;
          ASSERT_GT(image.splat_depth[i], 0) << kind.name << ' ' << i;
          for (int channel = 0; channel < 4; ++channel) {
            const float value = image.color.pixels[i][channel];
            ASSERT_TRUE(value >= 0 && value <= 1) << kind.name << ' ' << i << ": " << value;
          }
        }
      }
  }
}

}  // namespace oracle_splats_test
}  // namespace tureen::test
