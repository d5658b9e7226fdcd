#include "formats/common/splat_values.hpp"

#include <algorithm>
#include <cmath>

namespace tureen {

std::optional<glm::quat> unit_rotation(const glm::dquat& q) {
  // Divided by the largest part first, so that no square underflows or overflows.
  const double largest = std::max({std::abs(q.w), std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  const glm::dquat scaled = q / largest;
  const double length = largest * glm::length(scaled);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  // The parts of a unit quaternion, rounded to float, have a length within 2^-24 = 6e-8 of 1. Such
  // a quaternion stays bit for bit, so that a file that was written from it reads back unchanged.
  if (std::abs(length - 1) <= 6e-8) return glm::quat(q);
  return glm::quat(scaled / glm::length(scaled));
}

}  // namespace tureen
