// Finite vectors.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace tureen {

/// Whether no component is infinite or NaN.
template <class Real>
bool is_finite(const glm::vec<3, Real>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace tureen
