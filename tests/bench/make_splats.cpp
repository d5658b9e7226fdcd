// make_splats GAUSSIANS OUT: writes splats of another kind at the centres of a scene of Gaussians,
// for measurements of drawing. The file also has three cameras, at which the object takes 1/3, 2/3
// and twice the image's height; they serve the Gaussians, too.
//
// A triangle window is an equilateral triangle of random orientation; its corners are 2.2 times the
// mean distance to three neighbours away from its centre, as at the beginning of a training. sigma
// = 0.01 + exp N(0.15, 0.8) and opacity = sigmoid N(1, 2): hard and soft, faint and opaque ones.
// Those of the kind near-opaque are as at the end of a training to opaque triangles: sigma is 0.01
// to 0.1, opacity 0.9 to 1. Ellipsoids have semi-axes between 0.3 and 1 of the windows' size, and
// random networks. Harmonics are of degree 3: the Gaussian's constant and N(0, 0.05) for the
// others.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "camera/navigation.hpp"
#include "formats/scene_file.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/bench/run_program.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_splats.hpp"
#include "trainer/common/neighbours.hpp"

namespace tureen::test {
namespace {

enum class Kind { windows, near_opaque, ellipsoids };

TriangleWindows windows_at(std::span<const glm::dvec3> centers, std::span<const double> sizes,
                           Kind kind, Random& random) {
  TriangleWindows windows;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const glm::dvec3 normal = random.direction();
    const glm::dvec3 u = glm::normalize(glm::cross(normal, random.direction()));
    const glm::dvec3 v = glm::cross(normal, u);
    for (int corner = 0; corner < 3; ++corner) {
      const double angle = corner * 2.0943951023931953;  // 120 degrees
      windows.corners.emplace_back(centers[i] +
                                   sizes[i] * (std::cos(angle) * u + std::sin(angle) * v));
    }
    windows.sigma.push_back(float(kind == Kind::near_opaque
                                      ? random.uniform(0.01, 0.1)
                                      : 0.01 + std::exp(0.15 + 0.8 * random.normal())));
    windows.opacity.push_back(float(kind == Kind::near_opaque
                                        ? random.uniform(0.9, 1)
                                        : 1 / (1 + std::exp(-(1 + 2 * random.normal())))));
  }
  return windows;
}

NeuralDensities ellipsoids_at(std::span<const glm::dvec3> centers, std::span<const double> sizes,
                              Random& random, std::uint64_t seed) {
  // Centres and axes are replaced; rotations and networks stay.
  NeuralDensities result = std::get<NeuralDensities>(
      random_splats({"ellipsoids", "splatnet", SplatKind::Kernel::neural}, centers.size(), 1, seed)
          .kernel);
  for (std::size_t i = 0; i < centers.size(); ++i) {
    result.centers[i] = glm::vec3(centers[i]);
    for (int axis = 0; axis < 3; ++axis)
      result.semi_axes[i][axis] = float(sizes[i] * random.uniform(0.3, 1));
  }
  return result;
}

/// In the layer of the Gaussians.
Splats splats_at(const Splats& splats, const Gaussians& gaussians, Kind kind, std::uint64_t seed) {
  Random random(seed);
  const std::vector<glm::dvec3> centers(gaussians.centers.begin(), gaussians.centers.end());
  std::vector<double> sizes = trainer::nearest_distances(centers, 3);
  for (double& size : sizes) size = std::max(2.2 * size, 1e-6);  // coincident centres have 0
  Splats result{.color = {.degree = 3}};
  if (kind == Kind::ellipsoids) {
    result.kernel = ellipsoids_at(centers, sizes, random, seed);
    result.profile = *profile_named("splatnet");
  } else {
    result.kernel = windows_at(centers, sizes, kind, random);
    result.profile = *profile_named("triangle-splatting");
  }
  const std::size_t stored = harmonics::count(splats.color.degree), all = harmonics::count(3);
  for (std::size_t i = 0; i < centers.size(); ++i) {
    result.color.coefficients.push_back(splats.color.coefficients[i * stored]);
    for (std::size_t k = 1; k < all; ++k)
      result.color.coefficients.emplace_back(0.05 * random.normal(), 0.05 * random.normal(),
                                             0.05 * random.normal());
  }
  return result;
}

/// Of a box whose height along the up axis takes this fraction of the image's.
Camera camera_at(const Subject& subject, double fraction, const char* name) {
  const Lens lens;
  const glm::dvec3 up = glm::normalize(subject.up);
  const double height = glm::dot(glm::abs(up), subject.high - subject.low);
  const double distance = height / (2 * fraction * std::tan(0.5 * lens.fov_y));
  const glm::dvec3 eye =
      subject.center() + distance * direction_of(up, {.azimuth = 0.6, .elevation = 0});
  Camera camera = look_at(eye, subject.center(), up, lens.fov_y, lens.width, lens.height);
  camera.name = name;
  return camera;
}

int run(int argc, char** argv) {
  CLI::App app("Writes splats of another kind at the centres of a scene of Gaussians.");
  std::string in, out, kind = "windows";
  std::uint64_t seed = 1;
  app.add_option("GAUSSIANS", in, "scene with one layer of Gaussians")->required();
  app.add_option("OUT", out, "file to write")->required();
  app.add_option("--kind", kind)
      ->check(CLI::IsMember({"windows", "near-opaque", "ellipsoids"}))
      ->capture_default_str();
  app.add_option("--seed", seed)->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  Scene scene = read_scene(in);
  auto* splats = std::get_if<Splats>(&only_layer(scene).primitives);
  const auto* gaussians = splats ? std::get_if<Gaussians>(&splats->kernel) : nullptr;
  if (!gaussians) throw UsageError(in + " has no Gaussians");
  const Subject subject = subject_of(scene);
  *splats = splats_at(*splats, *gaussians,
                      kind == "windows"       ? Kind::windows
                      : kind == "near-opaque" ? Kind::near_opaque
                                              : Kind::ellipsoids,
                      seed);
  scene.cameras = {camera_at(subject, 1.0 / 3, "far"), camera_at(subject, 2.0 / 3, "mid"),
                   camera_at(subject, 2, "close")};
  scene.info.source = kind + " by make_splats";
  for (const std::string& note : write_scene(scene, out))
    std::fprintf(stderr, "%s\n", note.c_str());
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  return tureen::test::run_program("make_splats", tureen::test::run, argc, argv);
}
