// The axes that can be up, and the conversion of angles to degrees.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tureen::viewer {

/// Unit vectors in the order of the key U: the likelier first.
inline const std::array<glm::dvec3, 6> up_axes = {
    {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {-1, 0, 0}}};

/// Whether a unit vector is that axis, to within 2.6 degrees. An up axis from cameras deviates
/// slightly, and the axes are at least 90 degrees apart.
inline bool is_axis(const glm::dvec3& direction, const glm::dvec3& axis) {
  return glm::dot(direction, axis) > 0.999;
}

inline constexpr double degrees_per_radian = 57.295779513082320877;

}  // namespace tureen::viewer
