#include "scene/kernels/column.hpp"

#include <algorithm>
#include <array>
#include <glm/exponential.hpp>

namespace tureen {

std::string plural(std::string name) {
  if (name.ends_with("y")) return name.replace(name.size() - 1, 1, "ies");
  if (name.ends_with("is")) return name.replace(name.size() - 2, 2, "es");
  return name + "s";
}

void SplatBox::add(const glm::vec3& center, const glm::quat& rotation,
                   const glm::dvec3& semi_axes) {
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(rotation));
  glm::dvec3 squared(0.0);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 axis = axes[i] * semi_axes[i];
    squared += axis * axis;
  }
  const glm::dvec3 extent = glm::sqrt(squared);
  add(glm::vec3(glm::dvec3(center) - extent));
  add(glm::vec3(glm::dvec3(center) + extent));
}

SplatSize SplatSize::of_ellipsoid(const glm::dvec3& semi_axes) {
  std::array<double, 3> sorted{semi_axes.x, semi_axes.y, semi_axes.z};
  std::sort(sorted.begin(), sorted.end());
  return {sorted[2], sorted[1], sorted[0] == 0};
}

double largest_section(const glm::dvec3& semi_axes) {
  return std::max(
      {semi_axes.x * semi_axes.y, semi_axes.y * semi_axes.z, semi_axes.z * semi_axes.x});
}

}  // namespace tureen
