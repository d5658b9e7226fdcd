// Depth precision: cases D1 and D2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/renderer.hpp"
#include "scene/clip_range.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/trainer/fragments.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/common/kernels/fragments.hpp"

namespace tureen::test {
namespace depth_test {

constexpr int side = 16;
constexpr float extent = 60;  // of the scene; the eye is inside it

/// Two squares at z = 0 and z = -apart that fill any image, and small faces at the scene's ends.
/// Faces 0 and 1 are the rear square if `rear_first`.
TriangleSoup two_walls(float apart, bool rear_first) {
  std::vector<glm::vec3> corners;
  for (const bool rear : {rear_first, !rear_first}) {
    const float z = rear ? -apart : 0.0f, a = extent;
    corners.insert(corners.end(), {{-a, -a, z}, {a, -a, z}, {a, a, z}});
    corners.insert(corners.end(), {{-a, -a, z}, {a, a, z}, {-a, a, z}});
  }
  const float a = extent;
  corners.insert(corners.end(), {{-a, -a, -a}, {-a, -a + 1, -a}, {-a + 1, -a, -a}});
  corners.insert(corners.end(), {{a, a, a}, {a, a - 1, a}, {a - 1, a, a}});
  return soup_of(corners);
}

/// Distances from the eye to the front wall: five around each. Most are not exact in floats.
std::vector<double> distances() {
  std::vector<double> all;
  for (const double distance : {1, 2, 5, 10, 20, 50})
    for (const double nudge : {1.0, 1.037, 1.1, 1.21, 1.33}) all.push_back(distance * nudge);
  return all;
}

constexpr int steps_per_octave = 4;  // of the tested gaps

/// For each distance, the smallest tested gap from which on no pixel shows the rear wall, in either
/// drawing order.
std::vector<double> min_gaps(bool reversed) {
  const std::vector<double> from = distances();
  std::vector<double> gaps(from.size());
  // From 4 units down to 2^-27, which floats cannot distinguish from 0 next to 1.
  for (int k = 2 * steps_per_octave; k >= -27 * steps_per_octave; --k) {
    const auto apart = float(std::exp2(double(k) / steps_per_octave));
    for (const bool rear_first : {false, true}) {
      Renderer renderer =
          renderer_of(shared_context(), two_walls(apart, rear_first), glm::dvec3(0),
                      {.plan = {.reversed_depth = reversed, .site = ShadingSite::deferred}});
      for (std::size_t i = 0; i < from.size(); ++i) {
        if (gaps[i] > 0) continue;
        Camera camera = straight_camera(side, side, side);
        camera.view_from_world[3] = glm::dvec4(0, 0, -from[i], 1);
        renderer.draw({camera});
        for (const std::uint32_t face : faces_of(renderer))
          if ((face < 2) == rear_first) gaps[i] = std::exp2(double(k + 1) / steps_per_octave);
      }
    }
    if (*std::min_element(gaps.begin(), gaps.end()) > 0) break;
  }
  return gaps;
}

/// Half a unit in the last place of a float: the largest error of rounding to it.
double half_unit(double x) {
  const auto held = float(x);
  return (double(std::nextafter(held, INFINITY)) - double(held)) / 2;
}

/// The largest decrease of the gap between two walls by roundings, seen from this distance, in
/// reversed depth with the far plane at infinity: near * (1 / w).
double rounding_of_reversed(double distance, double near) {
  // The corner minus the eye's high half, minus its low half. The first difference is exact for the
  // wall at 0. w is the result: the walls are perpendicular to the axis, so nothing is added.
  const double of_corners = 3 * half_unit(distance);
  // The inverse and its product with near, for both walls. These derivatives convert an error in 1
  // / w or near / w to a distance.
  const double inverse_per_unit = 1 / (distance * distance);
  const double of_inverses = 2 * half_unit(1 / distance) / inverse_per_unit;
  const double of_depths = 2 * half_unit(near / distance) / (near * inverse_per_unit);
  return of_corners + of_inverses + of_depths;
}

/// The distance that one unit of 24 bits covers, with the far plane far beyond: depth is 1 - near /
/// distance, with derivative near / distance^2.
double unit_of_fixed(double distance, double near) { return distance * distance / near * epsilon; }

TEST(Numerics, D1_TwoWallsAreToldApart) {
  const std::vector<double> reversed = min_gaps(true), fixed = min_gaps(false);
  Recorder recorder({.stressed = "two walls one behind the other within a scene of radius 104: "
                                 "reversed depth in floats",
                     .parameter = "distance / units",
                     .unit = "smallest resolved gap / units",
                     .naive = "24 bits, near at a thousandth of the radius"});
  Recorder elsewhere({.stressed = "the same without clip control: 24 bits, as documented",
                      .parameter = "distance / units",
                      .unit = "smallest resolved gap / units"});
  const Bounds scene = bounds(two_walls(0, false));
  const double documented_near = 1e-3 * scene.radius();
  const double step = std::exp2(1.0 / steps_per_octave);
  const std::vector<double> from = distances();
  for (std::size_t i = 0; i < from.size(); ++i) {
    ASSERT_GT(reversed[i], 0) << "no gap is too small";
    ASSERT_GT(fixed[i], 0) << "no gap is too small";
    const double near =
        clip_range(scene, {0, 0, from[i]}, {0, 0, -1}, DepthStorage::reversed_float).near;
    // A gap larger than the roundings is resolved. The first tested gap beyond them may be one step
    // larger.
    recorder.add({.at = from[i],
                  .naive = fixed[i],
                  .ours = reversed[i],
                  .tolerance = step * rounding_of_reversed(from[i], near)});
    // Four units of depth: one so that two values can differ, and roundings of half a unit for each
    // wall from the corner minus the eye, the product and the quotient.
    elsewhere.add({.at = from[i],
                   .ours = fixed[i],
                   .tolerance = 4 * unit_of_fixed(from[i], documented_near)});
  }
}

/// The sorting key in DiffSoup's rasteriser.
float published_key(double z, double near, double far) {
  const auto ndc =
      float((far + near) / (far - near) - 2 * far * near / ((far - near) * double(float(z))));
  return ndc + 2.0f;
}

TEST(Numerics, D2_WinnersDoNotDependOnTheNearPlane) {
  Recorder recorder({.stressed =
                         "nearly coplanar layers at a depth of 10, trained with near at 0.01 "
                         "and at 0.5",
                     .parameter = "gap between layers / depth",
                     .unit = "of 4096 pixels show another layer",
                     .naive = "the baseline's keys, float(z_ndc + 2)"});
  constexpr int pixels = 64;
  const Camera camera = straight_camera(pixels, pixels, pixels);
  for (const double gap : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    std::vector<glm::vec3> corners;
    constexpr int layers = 8;
    for (int i = 0; i < layers; ++i) {
      const auto z = float(-10 * (1 + gap * ((i * 3 + 5) % layers)));
      // Tilted, so that each face has many depths.
      corners.insert(corners.end(), {{-20, -20, z}, {20, -20, z * 1.1f}, {0, 30, z * 0.9f}});
    }
    const TriangleSoup soup = soup_of(corners);
    const double ours =
        differing(faces_of_trainer(soup, camera, 0.01), faces_of_trainer(soup, camera, 0.5));
    // Depths in double, keys in floats. The first of several equal keys wins.
    std::vector<std::uint32_t> winners[2];
    for (const double near : {0.01, 0.5}) {
      std::vector<float> best(pixels * pixels, 1e9f);
      auto& winner = winners[near == 0.5];
      winner.assign(pixels * pixels, no_face);
      const trainer::kernels::View view = trainer::view_of(camera, glm::dvec3(0), near, 100);
      for (std::uint32_t face = 0; face < layers; ++face)
        trainer::test::for_each_fragment(
            view, trainer::kernels::project(view, &corners[3 * face].x), {0, 0, pixels, pixels},
            [&](const trainer::kernels::Fragment& f) {
              const auto i = std::size_t(f.y) * pixels + f.x;
              const float key = published_key(1 / double(f.inverse_depth), near, 100);
              if (!(key < best[i])) return;
              best[i] = key;
              winner[i] = face;
            });
    }
    const double naive = differing(winners[0], winners[1]);
    // A tenth of a key's step at this depth in the catalogue, 1.2e-3 at 10: many layers share a
    // key.
    if (gap < 1.2e-5) {
      EXPECT_GT(naive, 0) << gap;
    }
    recorder.add({.at = gap, .naive = naive, .ours = ours, .tolerance = 0});
  }
}

}  // namespace depth_test
}  // namespace tureen::test
