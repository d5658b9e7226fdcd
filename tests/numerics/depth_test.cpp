// Depth precision: the rows D1 and D2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "numerics/recorder.hpp"
#include "numerics/scenes.hpp"
#include "runtime/renderer.hpp"
#include "trainer/kernels/fragments.hpp"
#include "trainer/stages.hpp"

namespace tureen::test {
namespace {

constexpr int side = 16;
constexpr float extent = 60;  // of the scene, so that the eye is within it

/// Two squares at z = 0 and z = -apart that fill any picture, and something at the scene's ends.
/// Faces 0 and 1 are the rear one's where `rear_first`.
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

constexpr double distances[] = {1, 2, 5, 10, 20, 50};
constexpr double nudges[] = {1.0, 1.037, 1.1, 1.21, 1.33};  // of each of them

/// For each of the distances the least gap, in steps of a factor sqrt(2), from which on no pixel
/// shows the rear wall, whichever comes first and wherever exactly the eye is.
std::vector<double> least_gaps(bool reversed) {
  std::vector<double> gaps(std::size(distances));
  for (int k = -54; k <= 2; ++k) {
    const auto apart = float(std::exp2(0.5 * k));
    std::vector<bool> wrong(std::size(distances));
    for (const bool rear_first : {false, true}) {
      Renderer renderer(shared_context(), two_walls(apart, rear_first), glm::dvec3(0),
                        {.plan = {.reversed_depth = reversed, .site = ShadingSite::deferred}});
      for (std::size_t i = 0; i < std::size(distances); ++i)
        for (const double nudge : nudges) {
          Camera camera = straight_camera(side, side, side);
          camera.view_from_world[3] = glm::dvec4(0, 0, -distances[i] * nudge, 1);
          renderer.draw(camera);
          for (const std::uint32_t face : renderer.read_faces())
            if ((face < 2) == rear_first) wrong[i] = true;
        }
    }
    for (std::size_t i = 0; i < std::size(distances); ++i)
      if (wrong[i]) gaps[i] = std::exp2(0.5 * (k + 1));
  }
  return gaps;
}

/// The catalogue's table of what one unit of depth is in the world, reversed with the far plane far
/// beyond (its row for 0.01 and 1e5): 9e-8 at 1, 1e-6 at 10, 4e-6 at 50, and between them a power
/// of the distance.
double catalogued_unit(double distance) {
  struct Entry {
    double distance, unit;
  };
  constexpr Entry table[] = {{1, 9e-8}, {10, 1e-6}, {50, 4e-6}};
  const Entry& a = table[distance > 10 ? 1 : 0];
  const Entry& b = table[distance > 10 ? 2 : 1];
  const double t = std::log(distance / a.distance) / std::log(b.distance / a.distance);
  return a.unit * std::pow(b.unit / a.unit, t);
}

/// One unit of 24 bits, as the table has it for other near planes and a far plane far beyond.
double unit_of_fixed(double distance, double near) { return distance * distance / near * epsilon; }

TEST(Numerics, D1_TwoWallsAreToldApart) {
  const std::vector<double> reversed = least_gaps(true), fixed = least_gaps(false);
  Recorder recorder({.stressed = "two walls one behind the other within a scene of radius 104: "
                                 "reversed depth in floats",
                     .parameter = "distance / units",
                     .unit = "least gap / units",
                     .naive = "24 bits, near at a thousandth of the radius"});
  Recorder elsewhere({.stressed = "the same without clip control: 24 bits, as documented",
                      .parameter = "distance / units",
                      .unit = "least gap / units"});
  const double documented_near = 1e-3 * bounds(two_walls(0, false)).radius();
  for (std::size_t i = 0; i < std::size(distances); ++i) {
    // Four units of depth, of which one lets two values differ at all and the others are roundings
    // of half a unit for each wall: of the corner less the eye, of the product, of the quotient.
    recorder.add({.at = distances[i],
                  .naive = fixed[i],
                  .ours = reversed[i],
                  .tolerance = 4 * catalogued_unit(distances[i])});
    // Those of 24 bits grow with the square of the distance: they are taken where the eye is
    // furthest.
    elsewhere.add({.at = distances[i],
                   .ours = fixed[i],
                   .tolerance = 4 * unit_of_fixed(nudges[4] * distances[i], documented_near)});
  }
}

/// What sorts fragments in DiffSoup's rasteriser.
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
                     .naive = "keys float(z_ndc + 2), the published ones"});
  constexpr int pixels = 64;
  const Camera camera = straight_camera(pixels, pixels, pixels);
  for (const double gap : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    std::vector<glm::vec3> corners;
    constexpr int layers = 8;
    for (int i = 0; i < layers; ++i) {
      const auto z = float(-10 * (1 + gap * ((i * 3 + 5) % layers)));
      // Leaning, so that depths are many.
      corners.insert(corners.end(), {{-20, -20, z}, {20, -20, z * 1.1f}, {0, 30, z * 0.9f}});
    }
    const TriangleSoup soup = soup_of(corners);
    const double ours =
        differing(faces_of_trainer(soup, camera, 0.01), faces_of_trainer(soup, camera, 0.5));
    // Depths in double, keys in floats: the first of equal ones stays.
    std::vector<std::uint32_t> winners[2];
    for (const double near : {0.01, 0.5}) {
      std::vector<float> best(pixels * pixels, 1e9f);
      auto& winner = winners[near == 0.5];
      winner.assign(pixels * pixels, no_face);
      const trainer::kernels::View view = trainer::view_of(camera, glm::dvec3(0), near, 100);
      for (std::uint32_t face = 0; face < layers; ++face)
        trainer::kernels::for_each_fragment(
            view, trainer::kernels::project(view, &corners[3 * face].x), {0, 0, pixels, pixels},
            [&](const trainer::kernels::Fragment& f) {
              const auto i = std::size_t(f.y) * pixels + f.x;
              const float key = published_key(1 / double(f.inverse_depth), near, 100);
              if (!(key < best[i])) return;
              best[i] = key;
              winner[i] = face;
            });
    }
    recorder.add(
        {.at = gap, .naive = differing(winners[0], winners[1]), .ours = ours, .tolerance = 0});
  }
}

}  // namespace
}  // namespace tureen::test
