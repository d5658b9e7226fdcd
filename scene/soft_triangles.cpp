#include "scene/soft_triangles.hpp"

#include <algorithm>
#include <cstdio>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

double solidity(double opacity, double sigma) {
  return opacity * 2.0 / ((sigma + 1.0) * (sigma + 2.0));
}

OpaqueResult to_opaque(SoftTriangles soft, float minimum_opacity) {
  const std::size_t count = soft.sigma.size();
  const std::size_t per_face = harmonics::count(soft.degree);
  double mean_solidity = 0, mean_opacity = 0;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < count; ++t) {
    // Negated, so that a NaN opacity is dropped too.
    if (!(soft.opacity[t] >= minimum_opacity)) continue;
    mean_solidity += solidity(soft.opacity[t], soft.sigma[t]);
    mean_opacity += soft.opacity[t];
    if (kept != t) {
      std::copy_n(&soft.positions[3 * t], 3, &soft.positions[3 * kept]);
      std::copy_n(&soft.coefficients[per_face * t], per_face, &soft.coefficients[per_face * kept]);
    }
    ++kept;
  }
  soft.positions.resize(3 * kept);
  soft.coefficients.resize(per_face * kept);

  OpaqueResult result;
  result.soup.positions = std::move(soft.positions);
  result.soup.triangles.resize(kept);
  for (std::size_t t = 0; t < kept; ++t)
    result.soup.triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
  result.soup.appearance = Harmonics{.domain = Harmonics::Domain::face,
                                     .degree = soft.degree,
                                     .view = ViewConvention::eye_to_surface,
                                     .coefficients = std::move(soft.coefficients)};
  if (count == 0) return result;

  if (kept > 0)
    result.remarks.push_back(
        {.kind = Remark::Kind::soft_triangles_opaque,
         .values = {mean_solidity / double(kept), mean_opacity / double(kept)}});
  if (kept < count)
    result.remarks.push_back({.kind = Remark::Kind::soft_triangles_dropped,
                              .counts = {count - kept, count},
                              .values = {double(minimum_opacity)}});
  return result;
}

}  // namespace tureen
