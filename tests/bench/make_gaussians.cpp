// make_gaussians OUT --splats N: writes Gaussians like those of a trained object, for measurements
// of drawing against their number.
//
// They lie on a bumpy sphere, flat along its surface; the distance between neighbours is about a
// standard deviation, so each number covers the same pixels about as often. opacity =
// sigmoid N(1, 2); harmonics are of degree 3.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "formats/scene_file.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/bench/run_program.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {
namespace {

Splats gaussians_on_sphere(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  // Each splat has a square with this side on the unit sphere, of area 4 pi.
  const double spacing = std::sqrt(4 * 3.14159265358979 / double(count));
  Gaussians gaussians;
  Splats result{.color = {.degree = 3}, .profile = *profile_named("3dgs")};
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 direction = random.direction();
    const double bump = 0.1 * std::sin(9 * direction.x) * std::sin(7 * direction.y) +
                        0.5 * spacing * random.normal();
    gaussians.centers.emplace_back((1 + bump) * direction);
    const glm::dquat from_up(glm::dvec3(0, 0, 1), direction);
    gaussians.rotations.emplace_back(glm::normalize(from_up));
    gaussians.scales.emplace_back(spacing * std::exp(0.4 * random.normal()),
                                  spacing * std::exp(0.4 * random.normal()), 0.2 * spacing);
    gaussians.opacity.push_back(float(1 / (1 + std::exp(-(1 + 2 * random.normal())))));
    for (std::size_t k = 0; k < harmonics::count(3); ++k) {
      const double deviation = k == 0 ? 0.8 : 0.05;
      result.color.coefficients.emplace_back(
          deviation * random.normal(), deviation * random.normal(), deviation * random.normal());
    }
  }
  result.kernel = std::move(gaussians);
  return result;
}

int run(int argc, char** argv) {
  CLI::App app("Writes Gaussians on a bumpy sphere.");
  std::string out;
  std::size_t splats = 100'000;
  std::uint64_t seed = 1;
  app.add_option("OUT", out, "file to write")->required();
  app.add_option("--splats", splats, "their number")
      ->check(CLI::Range(1, 16'000'000))
      ->capture_default_str();
  app.add_option("--seed", seed)->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  Scene scene;
  scene.layers.push_back({.primitives = gaussians_on_sphere(splats, seed)});
  scene.info.source = "Gaussians on a bumpy sphere by make_gaussians";
  for (const std::string& note : write_scene(scene, out))
    std::fprintf(stderr, "%s\n", note.c_str());
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  return tureen::test::run_program("make_gaussians", tureen::test::run, argc, argv);
}
