// The sRGB transfer function (IEC 61966-2-1). Rendering never linearises Tureen's display-referred
// colours. These functions serve file formats with linear values, such as glTF.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace tureen {

/// Linear light in [0, 1] from a display-referred value; clamps, NaN becomes 0.
inline double linear_from_srgb(double encoded) {
  if (!(encoded > 0.0)) return 0.0;
  if (encoded >= 1.0) return 1.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// The inverse: a display-referred value in [0, 1] from linear light; clamps, NaN becomes 0.
inline double srgb_from_linear(double linear) {
  if (!(linear > 0.0)) return 0.0;
  if (linear >= 1.0) return 1.0;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

inline glm::dvec3 linear_from_srgb(const glm::dvec3& c) {
  return {linear_from_srgb(c.x), linear_from_srgb(c.y), linear_from_srgb(c.z)};
}

inline glm::dvec3 srgb_from_linear(const glm::dvec3& c) {
  return {srgb_from_linear(c.x), srgb_from_linear(c.y), srgb_from_linear(c.z)};
}

}  // namespace tureen
