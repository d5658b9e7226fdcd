#include "scene/edit/moved_normals.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scene/finite.hpp"

namespace tureen {

namespace {

double largest_of(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

glm::vec3 unit_or_zero(const glm::dvec3& normal) {
  // Unit vectors that were rounded to floats have squares within 1.1e-7 of 1.
  if (std::abs(glm::dot(normal, normal) - 1.0) <= 2e-7) return glm::vec3(normal);
  const double largest = largest_of(normal);
  // Elements of at most 1: their squares neither overflow nor vanish. Division by a subnormal
  // number is exact enough.
  return is_finite(normal) && largest > 0 ? glm::vec3(glm::normalize(normal / largest))
                                          : glm::vec3(0.0f);
}

bool is_unit_or_zero(const glm::vec3& normal) {
  // A normalised vector of floats is within 1.1e-7; other writers may compute in floats.
  return normal == glm::vec3(0.0f) ||
         std::abs(glm::dot(glm::dvec3(normal), glm::dvec3(normal)) - 1.0) <= 1e-5;
}

glm::dmat3 normal_matrix(const glm::dmat3& linear) {
  const double largest =
      std::max({largest_of(linear[0]), largest_of(linear[1]), largest_of(linear[2])});
  if (!(largest > 0) || !std::isfinite(largest)) return glm::dmat3(0.0);
  const glm::dvec3 a = linear[0] / largest, b = linear[1] / largest, c = linear[2] / largest;
  // The cofactors are the inverse transposed times the determinant.
  const glm::dmat3 cofactors(glm::cross(b, c), glm::cross(c, a), glm::cross(a, b));
  const double determinant = glm::dot(a, cofactors[0]);
  return cofactors * (determinant > 0 ? 1.0 : determinant < 0 ? -1.0 : 0.0);
}

void move_normals(std::vector<glm::vec3>& normals, const glm::dmat3& linear) {
  const glm::dmat3 matrix = normal_matrix(linear);
  for (glm::vec3& normal : normals) normal = unit_or_zero(matrix * glm::dvec3(normal));
}

}  // namespace tureen
