#include "tracing/optics.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tureen::tracing {

glm::dvec3 reflection(const glm::dvec3& direction, const glm::dvec3& normal) {
  return glm::normalize(direction - 2 * glm::dot(direction, normal) * normal);
}

Splitting at_boundary(const glm::dvec3& direction, const glm::dvec3& normal, double n1, double n2) {
  Splitting result{.reflected = reflection(direction, normal)};
  const double ratio = n1 / n2, in = std::min(-glm::dot(direction, normal), 1.0);
  const double squared = 1 - ratio * ratio * (1 - in * in);  // of the cosine behind
  if (!(squared > 0)) return result;
  const double out = std::sqrt(squared);
  result.refracted = glm::normalize(ratio * direction + (ratio * in - out) * normal);
  const double across = (n1 * in - n2 * out) / (n1 * in + n2 * out);
  const double within = (n1 * out - n2 * in) / (n1 * out + n2 * in);
  result.reflectance = 0.5 * (across * across + within * within);
  return result;
}

}  // namespace tureen::tracing
