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
  TriangleSoup soup;  // of 200 faces, without a defect()
  glm::dvec3 origin{0.0};
  Camera camera;
};

/// What a face of a scene has been made to be.
enum class Hazard {
  none,  // or without area, or a needle
  corner_at_the_eye,
  behind_the_eye,
  below_a_pixel,
  coincident,  // with the face four before it
};
Hazard hazard_of(std::uint32_t face);

/// Equal for equal arguments. What concerns single faces is in every scene. Of the others, by the
/// seed: one in three is large faces, one in four is seen from within, and one in three each lies
/// far away by its vertices, far away by its origin, and at home: 36 seeds have all of it together.
HazardousScene hazardous_scene(std::uint64_t seed, Kind kind, int width, int height);

}  // namespace tureen::test
