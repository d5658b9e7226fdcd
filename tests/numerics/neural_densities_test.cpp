// Numerical hazards of neural densities: small frequencies, large phases, distant eyes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runtime/passes/shader_source.hpp"
#include "tests/numerics/splat_scenes.hpp"
#include "tests/support/shader_probe.hpp"

namespace tureen::test {
namespace neural_densities_test {

constexpr int width = 64, height = 48;
constexpr std::size_t neurons = NeuralDensities::width;

/// Also with the centre at the eye or behind it.
SplatProfile density_profile() {
  SplatProfile profile = *profile_named("splatnet");
  profile.min_center_depth = 0;
  return profile;
}

/// A sphere of radius 1 before straight_camera(), with the density b2 + a cos(w . u + b1).
struct Sphere {
  double distance = 5;
  float b2 = 0, amplitude = 0, b1 = 0;
  glm::vec3 w{0};

  NeuralDensities density() const {
    NeuralDensities result{.centers = {glm::vec3(0, 0, float(-distance))},
                           .semi_axes = {glm::vec3(1)},
                           .rotations = {glm::quat(1, 0, 0, 0)},
                           .networks = std::vector<float>(NeuralDensities::parameters),
                           .omega = 1};
    for (int k = 0; k < 3; ++k) result.networks[std::size_t(k)] = w[k];
    result.networks[3 * neurons] = b1;
    result.networks[4 * neurons] = amplitude;
    result.networks[5 * neurons] = b2;
    return result;
  }
};

/// The sphere fills nine tenths of the image's height.
Camera camera_of(const Sphere& sphere) {
  return straight_camera(width, height, 0.45 * height * sphere.distance);
}

/// The largest difference from these alphas of a method in floats: the optical depth of a ray
/// (direction of unit length) with the sphere's centre.
double naive_error(const Sphere& sphere, const Camera& camera, const std::vector<double>& expected,
                   const std::function<float(glm::vec3 direction, glm::vec3 center)>& depth) {
  double error = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec3 direction(glm::normalize(ray_of_pixel(camera, x, y)));
      float alpha = -std::expm1(-depth(direction, glm::vec3(0, 0, float(-sphere.distance))));
      alpha = std::min(alpha, 0.99f);
      if (alpha < 1 / 255.0f) alpha = 0;
      error = worse(error, std::abs(double(alpha) - expected[std::size_t(y * width + x)]));
    }
  return error;
}

/// A pixel at the silhouette may be blended or not, by min_alpha.
constexpr double at_silhouette = 1.0 / 255;

TEST(Numerics, N1_SmallFrequenciesDoNotCancel) {
  Recorder recorder({.stressed = "a neuron that hardly varies along the rays",
                     .parameter = "its frequency along the axis",
                     .unit = "alpha",
                     .naive = "difference of the antiderivatives, divided by the frequency"});
  for (const float b : {1.0f, 1e-2f, 1e-4f, 1e-6f, 1e-8f, 0.0f}) {
    const Sphere sphere{.b2 = 0.5f, .amplitude = 0.4f, .b1 = 1, .w = {0, 0, b}};
    const Camera camera = camera_of(sphere);
    const Scene scene = scene_of(white_splats(sphere.density(), density_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const double naive =
        naive_error(sphere, camera, expected, [&](glm::vec3 direction, glm::vec3 center) {
          // The chord is exact up to one rounding.
          const glm::dvec3 d(direction), c(center);
          const double middle = glm::dot(c, d);
          const glm::dvec3 off = middle * d - c;
          const double squared = 1 - glm::dot(off, off);
          if (!(squared > 0)) return 0.0f;
          const auto half = float(std::sqrt(squared));
          const auto begin = float(middle) - half, end = float(middle) + half;
          const float frequency = b * direction.z, phase = -b * center.z + sphere.b1;
          return sphere.b2 * (end - begin) +
                 sphere.amplitude *
                     (std::sin(frequency * end + phase) - std::sin(frequency * begin + phase)) /
                     frequency;
        });
    // The chord's discriminant has roundings of 8 epsilon; at the silhouette, its square root has
    // their square root.
    recorder.add({.at = double(b),
                  .naive = naive,
                  .ours = alpha_error(scene, camera, expected),
                  .tolerance = std::max(at_silhouette, 2 * std::sqrt(8 * epsilon)) + 1e-5});
  }
}

TEST(Numerics, N2_DistantEyesKeepTheChord) {
  Recorder recorder({.stressed = "densities seen from afar",
                     .parameter = "distance / semi-axes",
                     .unit = "alpha",
                     .naive = "discriminant of the quadratic equation from the eye",
                     .naive_fails_from = 1e3});
  for (const double distance : {5.0, 100.0, 1e3, 1e4}) {
    const Sphere sphere{.distance = distance, .b2 = 0.5f};
    const Camera camera = camera_of(sphere);
    const Scene scene = scene_of(white_splats(sphere.density(), density_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const double naive =
        naive_error(sphere, camera, expected, [&](glm::vec3 direction, glm::vec3 center) {
          const float b = glm::dot(direction, center);
          const float squared = b * b - (glm::dot(center, center) - 1);
          return squared > 0 ? sphere.b2 * 2 * std::sqrt(squared) : 0.0f;
        });
    // As in N1.
    recorder.add({.at = distance,
                  .naive = naive,
                  .ours = alpha_error(scene, camera, expected),
                  .tolerance = at_silhouette + 1e-5});
  }
}

TEST(Numerics, N7_TheEyeInsideADensity) {
  Recorder recorder({.stressed = "the eye inside a density",
                     .parameter = "distance of the eye from the centre / semi-axes",
                     .unit = "alpha",
                     .naive = "integrate the whole chord"});
  for (const double distance : {0.0, 0.3, 0.9, 0.999}) {
    const Sphere sphere{.distance = distance, .b2 = 0.5f};
    const Camera camera = straight_camera(width, height, width);
    const Scene scene = scene_of(white_splats(sphere.density(), density_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const double naive =
        naive_error(sphere, camera, expected, [&](glm::vec3 direction, glm::vec3 center) {
          const glm::vec3 off = glm::dot(direction, center) * direction - center;
          return sphere.b2 * 2 * std::sqrt(1 - glm::dot(off, off));
        });
    // About twenty roundings of lengths up to 2.
    recorder.add({.at = distance,
                  .naive = naive,
                  .ours = alpha_error(scene, camera, expected),
                  .tolerance = 40 * epsilon + 1e-5});
  }
}

TEST(Numerics, N8_ThinDensitiesKeepTheirAlpha) {
  Recorder recorder({.stressed = "thin densities",
                     .parameter = "optical depth",
                     .unit = "relative error of alpha",
                     .naive = "1 - exp(-depth)"});
  for (const float depth : {0.1f, 0.006f, 0.004f, 1e-3f, 1e-4f, 1e-5f, 2e-6f}) {
    SplatProfile profile = density_profile();
    profile.min_alpha = 1e-6f;
    const Sphere sphere{.b2 = depth / 2};
    const Camera camera = camera_of(sphere);
    const Scene scene = scene_of(white_splats(sphere.density(), profile));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const std::vector<glm::vec4> blended = blended_by_device(scene, camera);
    double ours = 0, naive = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      // Away from the silhouette, whose rounding N1 and N2 measure.
      if (expected[i] < 0.6 * -std::expm1(-double(depth))) continue;
      ours = worse(ours, std::abs(double(blended[i].a) / expected[i] - 1));
      const auto exact = float(-std::log1p(-expected[i]));
      naive = worse(naive, std::abs(double(1.0f - std::exp(-exact)) / expected[i] - 1));
    }
    // The rounding of the chord: 8 epsilon in a discriminant above 0.3. Where the series ends,
    // 1 - exp(-0.005) has a rounding of epsilon / 0.005, and exp of the device perhaps twice that.
    recorder.add({.at = double(depth),
                  .naive = naive,
                  .ours = ours,
                  .tolerance = 8 * epsilon / 0.3 + 4 * epsilon / 0.005});
  }
}

TEST(Numerics, N12_LargePhasesAreReduced) {
  Recorder recorder({.stressed = "phases far outside of [-pi, pi]",
                     .parameter = "largest phase",
                     .unit = "alpha"});
  for (const float phase : {3.0f, 30.0f, 1e3f, 1e4f}) {
    const Sphere sphere{.b2 = 0.5f, .amplitude = 0.4f, .b1 = 1, .w = {phase, 0, 0}};
    const Camera camera = camera_of(sphere);
    const Scene scene = scene_of(white_splats(sphere.density(), density_profile()));
    // The silhouette as in N1. A phase has about ten roundings.
    recorder.add({.at = double(phase),
                  .ours = alpha_error(scene, camera, alpha_of_oracle(scene, camera)),
                  .tolerance = at_silhouette + 1e-5 + 10 * epsilon * double(phase)});
  }
  // GLSL specifies cos on [-pi, pi] only. No expectation: llvmpipe reduces the range itself.
  const Probe probe(shared_context().capabilities().api,
                    "vec4 probe(vec4 x) { return vec4(cos(x.x)); }", {});
  std::vector<glm::vec4> phases;
  for (int i = 0; i < 1000; ++i) phases.emplace_back(1000.0f + 0.37f * float(i));
  const std::vector<glm::vec4> cosines = probe.run(phases);
  double error = 0;
  for (std::size_t i = 0; i < phases.size(); ++i)
    error = worse(error, std::abs(double(cosines[i].x) - std::cos(double(phases[i].x))));
  RecordProperty("cos_without_reduction", std::to_string(error));
}

}  // namespace neural_densities_test
}  // namespace tureen::test
