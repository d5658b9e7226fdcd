#include "scene/opaque_windows.hpp"

#include <algorithm>
#include <cstdio>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

double solidity(double opacity, double sigma) {
  return opacity * 2.0 / ((sigma + 1.0) * (sigma + 2.0));
}

OpaqueResult to_opaque(Splats splats, float minimum_opacity) {
  auto& windows = std::get<TriangleWindows>(splats.kernel);
  SplatColor& color = splats.color;
  const std::size_t count = windows.sigma.size();
  const std::size_t per_face = harmonics::count(color.degree);
  double mean_solidity = 0, mean_opacity = 0;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < count; ++t) {
    // Negated, so that a NaN opacity is dropped too.
    if (!(windows.opacity[t] >= minimum_opacity)) continue;
    mean_solidity += solidity(windows.opacity[t], windows.sigma[t]);
    mean_opacity += windows.opacity[t];
    if (kept != t) {
      std::copy_n(&windows.corners[3 * t], 3, &windows.corners[3 * kept]);
      std::copy_n(&color.coefficients[per_face * t], per_face,
                  &color.coefficients[per_face * kept]);
    }
    ++kept;
  }
  windows.corners.resize(3 * kept);
  color.coefficients.resize(per_face * kept);

  OpaqueResult result;
  result.soup.positions = std::move(windows.corners);
  result.soup.triangles.resize(kept);
  for (std::size_t t = 0; t < kept; ++t)
    result.soup.triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
  result.soup.appearance = Harmonics{.domain = Harmonics::Domain::face,
                                     .degree = color.degree,
                                     .view = ViewConvention::eye_to_surface,
                                     .coefficients = std::move(color.coefficients)};
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
