// The axes that can be up, and angles as people read them.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tureen::viewer {

/// In the order in which the key goes through them: the likelier first. Of unit length.
inline const std::array<glm::dvec3, 6> up_axes = {
    {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {-1, 0, 0}}};

/// Whether a unit vector is that axis, to 2.6 degrees: an up that was taken from cameras is off by
/// a little, and no two of the axes are nearer than 90.
inline bool is_axis(const glm::dvec3& direction, const glm::dvec3& axis) {
  return glm::dot(direction, axis) > 0.999;
}

inline constexpr double degrees_per_radian = 57.295779513082320877;

}  // namespace tureen::viewer
