// Numerical hazards of neural densities: small frequencies, large phases, distant eyes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "formats/common/format_remarks.hpp"
#include "formats/ply_file.hpp"
#include "runtime/passes/shader_source.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/numerics/splat_tiles.hpp"
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
                  .ours = alpha_error_of_both(scene, camera, expected),
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
                  .ours = alpha_error_of_both(scene, camera, expected),
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
                  .ours = alpha_error_of_both(scene, camera, expected),
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
    const std::vector<glm::vec4> device = blended_by_device(scene, camera),
                                 tiles = blended_by_tiles(scene, camera);
    double ours = 0, naive = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      // Away from the silhouette, whose rounding N1 and N2 measure.
      if (expected[i] < 0.6 * -std::expm1(-double(depth))) continue;
      // The splat is white. Tiles keep the transmittance, and 1 minus that would cancel.
      for (const auto* blended : {&device, &tiles})
        ours = worse(ours, std::abs(double((*blended)[i].r) / expected[i] - 1));
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
                  .ours = alpha_error_of_both(scene, camera, alpha_of_oracle(scene, camera)),
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

/// A density of radius 1 whose centre is 2 before the eye, and a wall across the image at this
/// fraction of its chord. The image is a narrow bundle of rays through the centre.
struct DensityWithWall {
  Camera camera = straight_camera(9, 7, 1e5);
  Scene scene;

  DensityWithWall(float b2, double fraction)
      : scene(
            scene_of(white_splats(Sphere{.distance = 2, .b2 = b2}.density(), density_profile()))) {
    const auto z = float(-1 - 2 * fraction), size = -0.01f * z;
    scene.layers.push_back(
        {.primitives = soup_of({{-size, -size, z}, {size, -size, z}, {0, size, z}})});
  }
};

TEST(Numerics, N13_TheSilhouetteFromAfar) {
  Recorder recorder({.stressed = "the silhouette of a density in an oblique view",
                     .parameter = "distance / semi-axes",
                     .unit = "alpha",
                     .naive = "discriminant of the quadratic equation from the eye",
                     .naive_fails_from = 1e4});
  for (const double distance : {1e2, 1e3, 1e4}) {
    const Sphere sphere{.distance = distance, .b2 = 0.5f};
    NeuralDensities density = sphere.density();
    const glm::vec3 center(distance * glm::normalize(glm::dvec3(1, -0.6, -1.4)));
    density.centers = {center};
    Camera camera = look_at({0, 0, 0}, glm::dvec3(center), {0, 1, 0}, 1, width, height);
    camera.fx = camera.fy = camera_of(sphere).fx;
    const Scene scene = scene_of(white_splats(density, density_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(camera.view_from_world));
    double naive = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::vec3 ray(glm::normalize(world_from_view * ray_of_pixel(camera, x, y)));
        const float b = glm::dot(ray, center);
        const float squared = b * b - (glm::dot(center, center) - 1);
        const float alpha = squared > 0 ? -std::expm1(-2 * sphere.b2 * std::sqrt(squared)) : 0.0f;
        naive = worse(naive, std::abs(double(alpha) - expected[std::size_t(y * width + x)]));
      }
    // The ray's direction and the centre relative to the eye have about ten roundings, of lengths
    // of `distance`. They move the silhouette, where the chord is the square root of twice that.
    recorder.add({.at = distance,
                  .naive = naive,
                  .ours = alpha_error_of_both(scene, camera, expected),
                  .tolerance = at_silhouette + std::sqrt(2 * 10 * epsilon * distance)});
  }
}

TEST(Numerics, N14_ASoupLeavesLittleOfTheChord) {
  Recorder recorder({.stressed = "a soup that leaves a small part of the chord, whose depth is 0.5",
                     .parameter = "part of the chord",
                     .unit = "alpha",
                     .naive = "test the depth of the centre"});
  for (const double part : {1.0, 1e-1, 1e-2, 1e-4, 1e-6}) {
    const auto b2 = float(0.25 / part);
    const DensityWithWall wall(b2, part);
    const std::vector<double> expected = alpha_of_oracle(wall.scene, wall.camera);
    EXPECT_NEAR(expected[31], -std::expm1(-0.5), part < 1e-5 ? 0.05 : 1e-3);
    // The chord's begin and the depth of the soup have about ten roundings each, of lengths from 1
    // to 3: at 1e-6 these are a sixth of what is left.
    recorder.add({.at = part,
                  .naive = part < 0.5 ? expected[31] : 0,
                  .ours = alpha_error_of_both(wall.scene, wall.camera, expected),
                  .tolerance = 20 * epsilon * double(b2) + 1e-5});
  }
}

TEST(Numerics, N16_SoupsBeforeAndBehindTheChord) {
  Recorder recorder({.stressed = "soups before, in and behind a density",
                     .parameter = "place of the soup, from 0 to 1 along the chord",
                     .unit = "alpha",
                     .naive = "integrate from the chord's begin to the soup",
                     .naive_fails_from = 1.5});
  for (const double place : {-0.25, -1e-3, 1e-3, 0.5, 0.999, 1.5, 100.0}) {
    const DensityWithWall wall(0.5f, place);
    const std::vector<double> expected = alpha_of_oracle(wall.scene, wall.camera);
    EXPECT_EQ(expected[31] > 0, place >= 0.5);
    // About twenty roundings of lengths up to 3.
    recorder.add({.at = place,
                  .naive = place > 0 && place < 0.1
                               ? 0
                               : std::abs(-std::expm1(-0.5 * 2 * place) - expected[31]),
                  .ours = alpha_error_of_both(wall.scene, wall.camera, expected),
                  .tolerance = 60 * epsilon + 1e-5});
  }
}

TEST(Numerics, N15_LargeDensitiesAreOpaque) {
  Recorder recorder({.stressed = "large densities",
                     .parameter = "b2",
                     .unit = "alpha",
                     .naive = "(exp(depth) - 1) / exp(depth)",
                     .naive_fails_from = 1e2});
  for (const float b2 : {1.0f, 1e2f, 1e6f, 1e30f}) {
    const Sphere sphere{.b2 = b2};
    const Camera camera = camera_of(sphere);
    const auto of = [&](float density) {
      return scene_of(white_splats(Sphere{.b2 = density}.density(), density_profile()));
    };
    const std::vector<double> expected = alpha_of_oracle(of(b2), camera);
    const float exponential = std::exp(2 * b2);
    const float naive = std::min((exponential - 1) / exponential, 0.99f);
    const double alpha = expected[std::size_t(height / 2 * width + width / 2)];
    EXPECT_EQ(alpha_error_of_both(of(-b2), camera, std::vector<double>(expected.size())), 0);
    // A pixel's centre is at least 1e-3 pixels from the silhouette. The exponential and the chord
    // have about twenty roundings.
    recorder.add({.at = double(b2),
                  .naive = worse(0, std::abs(double(naive) - alpha)),
                  .ours = alpha_error_of_both(of(b2), camera, expected),
                  .tolerance = 1e-5});
  }
}

TEST(Numerics, N10_TinyAndEnormousSemiAxes) {
  Recorder recorder({.stressed = "a density, its distance and the scene in another unit",
                     .parameter = "logarithm of the semi-axes",
                     .unit = "alpha",
                     .naive = "discriminant with squares of lengths in floats",
                     .naive_fails_from = 60});
  for (const double log_s : {-30.0, -18.0, 0.0, 18.0, 45.0, 60.0, 80.0}) {
    const double s = std::exp(log_s);
    const Sphere sphere{.b2 = 0.5f, .amplitude = 0.4f, .b1 = 1, .w = {3, 0, 2}};
    const Camera camera = camera_of(sphere);
    NeuralDensities density = sphere.density();
    density.centers[0] *= s;
    density.semi_axes[0] *= s;
    const Scene scene = scene_of(white_splats(density, density_profile()));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    EXPECT_GT(expected[std::size_t(height / 2 * width + width / 2)], 0.1);
    const double naive =
        naive_error(sphere, camera, expected, [&](glm::vec3 direction, glm::vec3 center) {
          const auto scale = float(s);
          const glm::vec3 d = direction / scale, c = center;  // in the unit sphere's space
          const float b = glm::dot(d, c), dd = glm::dot(d, d);
          const float squared = b * b - dd * (glm::dot(c, c) - 1);
          if (squared < 0) return 0.0f;
          const float half = std::sqrt(squared) / dd / scale;
          const float t = b / dd / scale;
          const glm::vec3 u = t * direction - c;
          const float frequency = 3 * direction.x + 2 * direction.z;
          const float phase = 3 * u.x + 2 * u.z + sphere.b1;
          return 2 * half * sphere.b2 +
                 2 * sphere.amplitude * std::sin(frequency * half) * std::cos(phase) / frequency;
        });
    // As in N1.
    recorder.add({.at = log_s,
                  .naive = naive,
                  .ours = alpha_error_of_both(scene, camera, expected),
                  .tolerance = std::max(at_silhouette, 2 * std::sqrt(8 * epsilon)) + 1e-5});
  }
}

/// A file of two densities, whose second has this quaternion.
Scene densities_in_file(const glm::dquat& rotation) {
  const PlyFixture::Columns columns = density_columns();
  const auto place = [&](const char* name) {
    return std::size_t(std::find(columns.begin(), columns.end(), name) - columns.begin());
  };
  std::vector<std::vector<double>> rows(2, std::vector<double>(columns.size(), 0.5));
  const std::size_t first = place("float rot_0");
  const double parts[] = {rotation.w, rotation.x, rotation.y, rotation.z};
  for (std::size_t k = 0; k < 4; ++k) rows[1][first + k] = parts[k];
  rows[1][place("float x")] = 1e3;  // stays the second in the order of the reader
  const std::string text = PlyFixture().element("vertex", columns, rows).text();
  Input input = Input::memory("a.ply", std::as_bytes(std::span(text)));
  return read_ply(input);
}

TEST(Numerics, N11_QuaternionsOfAnyLength) {
  Recorder recorder({.stressed = "stored quaternions that are not of unit length",
                     .parameter = "their length",
                     .unit = "of a part of the rotation",
                     .naive = "divide by the square root of the sum of squares in floats"});
  const glm::dquat unit = glm::normalize(glm::dquat(0.3, -0.5, 0.7, 0.2));
  for (const double length : {1e-37, 1e-25, 1e-20, 1e-3, 1.0, 1e3, 1e20, 1e37}) {
    const Scene scene = densities_in_file(unit * length);
    const auto& densities =
        std::get<NeuralDensities>(std::get<Splats>(scene.layers[0].primitives).kernel);
    ASSERT_EQ(densities.rotations.size(), 2u) << length;
    const glm::quat stored(unit * length);
    const glm::quat naive = stored / std::sqrt(glm::dot(stored, stored));
    double off = 0, naive_off = 0;
    for (int k = 0; k < 4; ++k) {
      off = worse(off, std::abs(double(densities.rotations[1][k]) - unit[k]));
      naive_off = worse(naive_off, std::abs(double(naive[k]) - unit[k]));
    }
    // The stored parts and those of the result are rounded.
    recorder.add({.at = length, .naive = naive_off, .ours = off, .tolerance = 3 * epsilon});
  }
  // Without a direction there is no rotation: such a splat is dropped, and counted.
  const Scene scene = densities_in_file({0, 0, 0, 0});
  EXPECT_EQ(count(std::get<Splats>(scene.layers[0].primitives)), 1u);
  EXPECT_EQ(scene.info.remarks.back(),
            (Remark{&remarks::splats_dropped, {{"dropped", 1}, {"all", 2}}}));
}

}  // namespace neural_densities_test
}  // namespace tureen::test
