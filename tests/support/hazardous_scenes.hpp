// Scenes that mix the hazards of geometry in docs/numerics.md: faces without area (G1), needles
// (G2), vertices and eyes far from the origin (G3), faces that begin behind the eye (G4), corners
// in the eye's plane (G5), an eye among the faces (G6), faces below a pixel (G7), faces of negative
// depth (G8) and coincident ones (G9).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {

struct HazardousScene {
  TriangleSoup soup;  // 200 faces, without a defect()
  glm::dvec3 origin{0.0};
  Camera camera;
};

/// The hazard that a face of a scene was made for.
enum class Hazard {
  none,  // ordinary, without area, or a needle
  corner_at_the_eye,
  behind_the_eye,
  below_a_pixel,
  coincident,  // with the fourth face before it
};
Hazard hazard_of(std::uint32_t face);

/// Equal for equal arguments. Every scene has the hazards of single faces. The others depend on the
/// seed: one scene in three has large faces, and one in four has the eye inside. A third of the
/// scenes has distant vertices, a third a distant origin, a third neither. 36 seeds give all
/// combinations.
HazardousScene hazardous_scene(std::uint64_t seed, Kind kind, int width, int height);

}  // namespace tureen::test
