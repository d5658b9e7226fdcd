#include "trainer/common/random_points.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tureen::trainer {

glm::dvec3 far_point(const Region& region, double far_extent, Random& random) {
  glm::dvec3 direction(0.0);
  while (glm::length(direction) < 0.1) direction = random.in_ball();  // short ones are inexact
  direction = glm::normalize(direction);
  const glm::dvec3 size = glm::abs(direction);
  const double border = 1 / std::max({size.x, size.y, size.z});  // where it leaves the cube
  const double distance = border * std::pow(std::max(far_extent / border, 1.0), random.uniform());
  return region.center + region.half_side * distance * direction;
}

glm::dvec3 near_point(const Region& region, Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return region.center + region.half_side * glm::dvec3(x, y, z);
}

}  // namespace tureen::trainer
