// Numerical hazards of the frames of splats: rotations and axes, as files store them, and flat
// axes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "formats/ply_file.hpp"
#include "formats/splat/octagon_npz.hpp"
#include "scene/similarity.hpp"
#include "tests/formats/splat/octagon_fixture.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/numerics/splat_tiles.hpp"

namespace tureen::test {
namespace splat_frames_test {

constexpr int width = 64, height = 48;

/// The bytes must outlive the input.
Input input_of(const std::string& bytes) {
  return Input::memory("splats", std::as_bytes(std::span(bytes)));
}

TEST(Numerics, E6_QuaternionsOfAnyLength) {
  Recorder recorder({.stressed = "quaternions of a PLY file that are not of unit length",
                     .parameter = "length",
                     .unit = "difference of a quaternion's part",
                     .naive = "divide by the root of the sum of squares, in floats"});
  const glm::dquat unit = glm::normalize(glm::dquat(0.3, -0.7, 0.2, 0.5));
  for (const double length : {0.0, 1e-37, 1e-30, 1e-20, 1e-3, 1.0, 1e3, 1e20, 1e30, 1e38}) {
    const auto row = [](const glm::dquat& q) {
      return std::vector<double>{1, 2, 3, 0, 0, 0, 0, 0, 0, 0, -1, -1, -1, q.w, q.x, q.y, q.z};
    };
    const std::string text =
        PlyFixture().element("vertex", splat_columns(0, 3), {row(length * unit), row(unit)}).text();
    Input input = input_of(text);
    const Scene scene = read_ply(input);
    const Gaussians& gaussians = only_gaussians(scene);
    // Without a direction there is no rotation: such a splat is dropped, with a remark.
    EXPECT_EQ(gaussians.centers.size(), length > 0 ? 2u : 1u);
    const auto off = [&](const glm::quat& q) {
      double error = 0;
      for (int i = 0; i < 4; ++i) error = worse(error, std::abs(double(q[i]) - unit[i]));
      return error;
    };
    double ours = 0;
    for (const glm::quat& q : gaussians.rotations) ours = worse(ours, off(q));
    const glm::quat stored(length * unit);
    // The rounding in the file, and of the result.
    recorder.add({.at = length,
                  .naive = off(stored / std::sqrt(glm::dot(stored, stored))),
                  .ours = ours,
                  .tolerance = 2 * epsilon});
  }
}

/// A disc of the profile redisplats before straight_camera(), tilted.
Gaussians tilted_disc(double distance, const glm::dvec3& scales) {
  return {.centers = {glm::vec3(0, 0, float(-distance))},
          .scales = {glm::vec3(scales)},
          .rotations = {glm::quat(glm::normalize(glm::dquat(1, 0.5, 0.2, 0.3)))},
          .opacity = {0.9f},
          .flat = true};
}

TEST(Numerics, F1_DiscsNeedNoThickness) {
  Recorder recorder({.stressed = "discs seen from far, with a lens that magnifies them, device and "
                                 "tiles",
                     .parameter = "distance / standard deviations",
                     .unit = "alpha",
                     .naive = "a Gaussian with a normal axis of 1e-5, the largest density along "
                              "the ray in floats",
                     .naive_fails_from = 20});
  for (const double distance : {2.0, 20.0, 100.0, 1e4}) {
    const Camera camera = straight_camera(width, height, width * distance / 6);
    const Gaussians disc = tilted_disc(distance, {1, 0.8, 0});
    const Scene scene = scene_of(white_splats(disc, *profile_named("redisplats")));
    const std::vector<double> expected = alpha_of_oracle(scene, camera);
    const glm::mat3 to_local = glm::transpose(glm::mat3_cast(disc.rotations[0]));
    const glm::vec3 inverse(1, 1 / 0.8f, 1e5f);
    double naive = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::vec3 ray(glm::normalize(ray_of_pixel(camera, x, y)));
        const glm::vec3 o = inverse * (to_local * -disc.centers[0]);
        const glm::vec3 d = inverse * (to_local * ray);
        const glm::vec3 nearest = o - glm::dot(o, d) / glm::dot(d, d) * d;
        float alpha = 0.9f * std::exp(-0.5f * glm::dot(nearest, nearest));
        if (alpha < 1 / 255.0f) alpha = 0;
        naive = worse(naive, std::abs(double(alpha) - expected[std::size_t(y * width + x)]));
      }
    // A pixel's offset from the centre's image has the roundings of a coordinate of 64 pixels. A
    // standard deviation is at least 4 pixels, and alpha changes by at most 0.55 of the offset's
    // error in standard deviations. 2e-6 for exp.
    recorder.add({.at = distance,
                  .naive = naive,
                  .ours = alpha_error_of_both(scene, camera, expected),
                  .tolerance = 0.55 * vertex_rounding(width) / 4 + 2e-6});
  }
}

Scene read_octagon(const glm::dvec3& x, const glm::dvec3& y, double q) {
  const std::string bytes = OctagonFixture().add({0.3, 0.2, -6}, x, y, {1, 1, 1, 0.9}, q).bytes();
  ReadOptions options;
  options.octagon_q = q;
  return read_octagon_npz(input_of(bytes), options);
}

TEST(Numerics, F10_OctagonsEndAtTheRootOfQ) {
  Recorder recorder({.stressed = "octagons of REdiSplats, read as discs",
                     .parameter = "quantile Q",
                     .unit = "relative error of a standard deviation",
                     .naive = "the octagon's radius is Q standard deviations"});
  for (const double q : {0.5, 1.0, 4.0, 11.34}) {
    const Scene scene = read_octagon({0.7, 0.1, 0}, {-0.04, 0.28, 0}, q);
    const glm::vec3& scales = only_gaussians(scene).scales[0];
    const double longest = std::hypot(0.7, 0.1), shortest = std::hypot(0.04, 0.28);
    const auto error = [&](double factor) {
      return worse(std::abs(factor * double(scales.x) / longest - 1),
                   std::abs(factor * double(scales.y) / shortest - 1));
    };
    // The file holds doubles; only the result is rounded.
    recorder.add(
        {.at = q, .naive = error(1 / std::sqrt(q)), .ours = error(1), .tolerance = 1.01 * epsilon});
  }
}

TEST(Numerics, F12_EqualAxesMayTurnButTheDiscStays) {
  Recorder recorder({.stressed = "octagons with nearly equal axes, whose frame is arbitrary",
                     .parameter = "relative difference of the axes",
                     .unit = "alpha",
                     .naive = "keep the frame of the neighbour, and take the scales anew",
                     .naive_fails_from = 1e-2});
  const Camera camera = straight_camera(width, height, width);
  for (const double difference : {0.0, 1e-12, 1e-7, 1e-4, 1e-2, 0.1}) {
    const glm::dvec3 x(0.5, 0, 0), y(0, 0.5, 0);
    const auto truth = [&](const glm::dvec3& a, const glm::dvec3& b) {
      // alpha by the inverse of the matrix of the two axes.
      std::vector<double> result;
      const double area = a.x * b.y - a.y * b.x;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
          const glm::dvec3 at = 6.0 * ray_of_pixel(camera, u, v) - glm::dvec3(0.3, 0.2, -6);
          const double s = (at.x * b.y - at.y * b.x) / area, t = (a.x * at.y - a.y * at.x) / area;
          const double alpha = double(0.9f) * std::exp(-0.5 * (s * s + t * t));
          result.push_back(alpha < 1 / 255.0 ? 0 : alpha);
        }
      return result;
    };
    const auto largest = [](const std::vector<double>& a, const std::vector<double>& b) {
      double error = 0;
      for (std::size_t i = 0; i < a.size(); ++i) error = worse(error, std::abs(a[i] - b[i]));
      return error;
    };
    double ours = 0, naive = 0;
    const double longer = 1 + difference;
    // The disc is longer along one axis, or along the other, or along the diagonal.
    const std::array<std::array<glm::dvec3, 2>, 3> shapes{
        {{longer * x, y}, {x, longer * y}, {x + difference * y, y + difference * x}}};
    Gaussians first;
    for (const auto& [a, b] : shapes) {
      const Scene scene = read_octagon(a, b, 4);
      ours = worse(ours, largest(alpha_of_oracle(scene, camera), truth(a, b)));
      Gaussians kept = only_gaussians(scene);
      if (first.centers.empty()) first = kept;
      kept.rotations = first.rotations;
      naive = worse(
          naive, largest(alpha_of_oracle(scene_of(white_splats(kept, *profile_named("redisplats"))),
                                         camera),
                         truth(a, b)));
    }
    // alpha changes by at most 0.37 of the relative error of q, which has the roundings of the
    // scales, twice, and of the quaternion, eight times; and by 0.55 of the centre's error in
    // standard deviations, 12 times its rounding.
    recorder.add({.at = difference,
                  .naive = naive,
                  .ours = ours,
                  .tolerance = (0.37 * 10 + 0.55 * 12) * epsilon});
  }
}

TEST(Numerics, F13_ManyTurnsOfALayerDoNotDrift) {
  Recorder recorder(
      {.stressed = "a layer that is turned by a degree many times, through its angles",
       .parameter = "turns",
       .unit = "largest difference of an axis",
       .naive = "multiply matrices of floats",
       .naive_fails_from = 1e3});
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -0.5));
  const double angle = M_PI / 180;
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, axis);
  for (const int turns : {1, 100, 1000, 10'000}) {
    glm::dmat4 ours(1.0);
    glm::mat4 naive(1.0f);
    for (int i = 0; i < turns; ++i) {
      // As the window does: the numbers that it shows are edited, and the matrix is made of them.
      ours = matrix_of(similarity_of(turn * ours));
      naive = glm::mat4(turn) * naive;
    }
    const glm::dmat4 expected = glm::rotate(glm::dmat4(1.0), turns * angle, axis);
    const auto error = [&](const glm::dmat4& m) {
      double worst = 0;
      for (int k = 0; k < 3; ++k) worst = worse(worst, glm::length(m[k] - expected[k]));
      return worst;
    };
    // Each turn has roundings of doubles: of the product, the angles and their functions. They are
    // stretched near an angle of 90 degrees about y, where that angle's cosine is small.
    recorder.add({.at = double(turns),
                  .naive = error(glm::dmat4(naive)),
                  .ours = error(ours),
                  .tolerance = 1e-14 * turns + 1e-14});
  }
}

}  // namespace splat_frames_test
}  // namespace tureen::test
