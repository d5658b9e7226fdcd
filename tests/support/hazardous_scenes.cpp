#include "tests/support/hazardous_scenes.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

namespace tureen::test {

namespace {

/// Depths of corners in front of the eye's plane, in it and behind it, up to the precision of
/// floats.
constexpr double depths_next_to_the_eye[] = {0.0, 1e-30, -1e-30, 1e-7, -1e-7, 1e-3, -1e-3};

/// Changes each face as hazard_of states. Requires three vertices a face.
void mix_in(Random& random, const Camera& camera, std::span<glm::vec3> positions) {
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const glm::dvec3 eye = camera.eye(), forward = -axes[2];
  const std::size_t faces = positions.size() / 3;
  for (std::size_t t = 0; t < faces; ++t) {
    const std::span<glm::vec3> corners = positions.subspan(3 * t, 3);
    switch (hazard_of(std::uint32_t(t))) {
      case Hazard::none:
        break;
      case Hazard::corner_at_the_eye:
        corners[random.below(3)] = glm::vec3(
            eye + random.uniform(-1, 1) * axes[0] + random.uniform(-1, 1) * axes[1] +
            depths_next_to_the_eye[random.below(std::size(depths_next_to_the_eye))] * forward);
        break;
      case Hazard::behind_the_eye:
        for (glm::vec3& p : corners) p = glm::vec3(2.0 * eye - glm::dvec3(p));
        break;
      case Hazard::below_a_pixel: {
        // About half a pixel large: some faces cover a pixel centre, most do not.
        const glm::dvec3 center(corners[0]);
        const double pixel = std::abs(glm::dot(center - eye, forward)) / camera.fx;
        for (glm::vec3& p : corners)
          p = glm::vec3(center +
                        0.5 * pixel * (random.normal() * axes[0] + random.normal() * axes[1]));
        break;
      }
      case Hazard::coincident:
        for (std::size_t k = 0; k < 3; ++k) corners[k] = positions[3 * (t - 4) + k];
        break;
    }
  }
}

}  // namespace

Hazard hazard_of(std::uint32_t face) {
  // random_soup made every fourth face, t % 4 == 1, degenerate. The first of eight stays unchanged.
  if (face % 64 == 2) return Hazard::corner_at_the_eye;
  if (face % 64 == 34) return Hazard::behind_the_eye;
  if (face % 8 == 3) return Hazard::below_a_pixel;
  if (face % 8 == 4) return Hazard::coincident;
  return Hazard::none;
}

HazardousScene hazardous_scene(std::uint64_t seed, Kind kind, int width, int height) {
  HazardousScene scene;
  scene.soup =
      random_soup(seed, {.kind = kind, .size = seed % 3 == 0 ? 0.5 : 0.15, .degenerate = true});
  Random random(seed);
  scene.camera = random_camera(random, width, height);
  if (seed % 4 == 0) scene.camera.view_from_world[3] *= glm::dvec4(0.25, 0.25, 0.25, 1);
  mix_in(random, scene.camera, scene.soup.positions);

  // At a distance of 2^10 units, vertices have 14 fractional bits. An origin of doubles may be
  // further away.
  const glm::dvec3 direction(1, -0.5, 0.75);
  glm::dvec3 shift(0);
  switch (seed / 12 % 3) {
    case 0:
      shift = 0x1p10 * direction;
      for (glm::vec3& p : scene.soup.positions) p = glm::vec3(glm::dvec3(p) + shift);
      break;
    case 1:
      shift = scene.origin = 1e6 * direction;
      break;
    default:
      break;
  }
  scene.camera.view_from_world =
      scene.camera.view_from_world * glm::translate(glm::dmat4(1), -shift);
  return scene;
}

}  // namespace tureen::test
