// One splat of a file, and the rule of all readers for its rotation.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace tureen {

/// One splat after activation.
struct SplatValues {
  glm::dvec3 center{0.0};
  glm::dvec3 scales{1.0};                   // or semi-axes, in layer units
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  // layer from local coordinates, of any length but 0
  double opacity = 1;                       // not for neural densities
};

/// The quaternion of unit length, rounded to float. nullopt if its length is 0 or not finite. A
/// quaternion that already has this length, up to the rounding of its parts, keeps its bits.
std::optional<glm::quat> unit_rotation(const glm::dquat& q);

}  // namespace tureen
