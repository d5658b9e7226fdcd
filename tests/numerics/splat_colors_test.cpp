// Numerical hazards of the colours of splats: the direction of harmonics, and values beyond the
// range of half floats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "scene/spherical_harmonics.hpp"
#include "tests/numerics/splat_tiles.hpp"

namespace tureen::test {
namespace splat_colors_test {

constexpr int side = 16;

/// Degree 1, so that each channel depends on the direction.
SplatColor directional_color() {
  return {.degree = 1,
          .coefficients = {
              {0.2f, 0.1f, -0.3f}, {0.3f, -0.2f, 0.1f}, {0.25f, 0.3f, -0.1f}, {-0.2f, 0.1f, 0.3f}}};
}

/// The largest difference of a channel at a pixel in the middle, where one splat is visible.
double color_error(const std::vector<glm::vec4>& blended, const glm::dvec3& expected) {
  const glm::vec4& pixel = blended[side / 2 * side + side / 2];
  EXPECT_GT(pixel.a, 0.01f);
  double error = 0;
  for (int c = 0; c < 3; ++c)
    error = worse(error, std::abs(double(pixel[c]) / double(pixel.a) - expected[c]));
  return error;
}

TEST(Numerics, V5b_SplatsVeryNearAndVeryFarHaveTheirColour) {
  Recorder recorder({.stressed = "harmonics of splats very near to the eye or very far from it: a "
                                 "neural density around the eye, a Gaussian, also in tiles",
                     .parameter = "distance / units",
                     .unit = "largest difference of a channel",
                     .naive = "the offset in floats, divided by its length"});
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -2));
  for (const double distance : {0.0, 1e-37, 1e-30, 1e-23, 1e-18, 1.0, 1e18, 1e20, 1e30}) {
    const glm::vec3 center(distance * axis);
    const Camera camera = look_at({0, 0, 0}, axis, {0, 1, 0}, 0.5, side, side);
    Splats splats{.color = directional_color()};
    const bool near = distance < 1e-10;
    if (near) {
      NeuralDensities density{.centers = {center},
                              .semi_axes = {glm::vec3(1)},
                              .rotations = {glm::quat(1, 0, 0, 0)},
                              .networks = std::vector<float>(NeuralDensities::parameters)};
      density.networks.back() = 1;
      splats.kernel = density;
      splats.profile = *profile_named("splatnet");
      splats.profile.min_center_depth = 0;
    } else {
      splats.kernel = Gaussians{.centers = {center},
                                .scales = {glm::vec3(float(0.1 * distance))},
                                .rotations = {glm::quat(1, 0, 0, 0)},
                                .opacity = {0.9f}};
      splats.profile = *profile_named("3dgs");
    }
    const glm::dvec3 stored(center);
    const auto basis =
        harmonics::basis(distance > 0 ? stored / glm::length(stored) : glm::dvec3(0, 0, 1));
    glm::dvec3 expected(0.5);
    for (std::size_t k = 0; k < 4; ++k)
      expected += basis[k] * glm::dvec3(splats.color.coefficients[k]);
    const Scene scene = scene_of(std::move(splats));
    const double ours = worse(color_error(blended_by_device(scene, camera), expected),
                              color_error(blended_by_tiles(scene, camera), expected));

    const glm::vec3 divided = center / glm::length(center);
    double naive = 0;
    for (int c = 0; c < 3; ++c)
      naive = worse(naive,
                    glm::length(divided) < 2 ? double(std::abs(divided[c] - float(axis[c]))) : NAN);
    // Four terms of at most 0.3 x 0.49 and one half with five roundings each (V5), and two of the
    // quotient by alpha.
    recorder.add({.at = distance,
                  .naive = naive,
                  .ours = ours,
                  .tolerance = (5 + 2) * (4 * 0.3 * 0.49 + 0.5) * epsilon});
  }
}

TEST(Numerics, E7_ColoursBeyondHalfFloatsAreWhite) {
  Recorder recorder({.stressed = "opaque splats with a huge red and a negative green, one behind "
                                 "the other; targets of floats and of halves, also in tiles",
                     .parameter = "coefficients",
                     .unit = "largest difference of a shown channel",
                     .naive = "blend in floats without a limit: the colour times a transmittance "
                              "of 0"});
  const Camera camera = straight_camera(side, side, side);
  for (const float coefficient : {1.0f, 1e3f, 3e5f, 1e10f, 3e38f}) {
    Gaussians gaussians;
    Splats splats{.profile = *profile_named("3dgs")};
    splats.profile.max_alpha = 1;
    splats.profile.stop_transmittance = 0;  // an opaque splat would end its pixels unseen
    splats.color.degree = 2;
    // The first covers a part of the image.
    for (const float scale : {0.3f, 1e4f, 1e4f}) {
      gaussians.centers.emplace_back(0, 0, -4 - float(gaussians.centers.size()));
      gaussians.scales.emplace_back(scale);
      gaussians.rotations.emplace_back(1, 0, 0, 0);
      gaussians.opacity.push_back(1);
      std::vector<glm::vec3> terms(9);
      terms[0] = {coefficient, -coefficient, 0.3f};
      terms[2] = {-coefficient, 0, 0};  // of z = -1
      terms[6] = {coefficient, 0, 0};   // of z^2: beyond the largest float
      splats.color.coefficients.insert(splats.color.coefficients.end(), terms.begin(), terms.end());
    }
    splats.kernel = gaussians;
    const Scene scene = scene_of(std::move(splats));
    const OracleImage expected = render_oracle(scene, {camera});
    const auto error = [&](const std::vector<glm::vec4>& blended) {
      double worst = 0;
      for (std::size_t i = 0; i < blended.size(); ++i)
        for (int c = 0; c < 3; ++c) {
          const auto shown = double(blended[i][c]);
          worst = worse(worst, std::isfinite(shown) ? std::abs(std::clamp(shown, 0.0, 1.0) -
                                                               double(expected.color.pixels[i][c]))
                                                    : NAN);
        }
      return worst;
    };
    double ours = error(blended_by_tiles(scene, camera));
    for (const SplatFormat target : {SplatFormat::rgba32f, SplatFormat::rgba16f})
      ours = worse(ours, error(blended_by_device(scene, camera, {.splat_format = target})));
    const float red = 0.5f + (0.28209479f + 0.48860251f + 0.63078313f) * coefficient;
    // Halves have eleven digits, and each of three splats rounds the sum.
    recorder.add({.at = double(coefficient),
                  .naive = double(red * 0.0f),
                  .ours = ours,
                  .tolerance = 3 * 0x1p-11});
  }
}

}  // namespace splat_colors_test
}  // namespace tureen::test
