// Triangle windows: soft triangles.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>

#include "scene/kernels/column.hpp"

namespace tureen {

/// Triangle Splatting (arXiv 2505.19175). alpha = opacity * rho^sigma, where rho is the distance
/// from the nearest edge over the inradius, both in the image: 1 at the incenter, 0 on the edges.
/// The centre is the mean of the corners.
struct TriangleWindows {
  std::vector<glm::vec3> corners;  // three a splat
  std::vector<float> sigma;        // > 0
  std::vector<float> opacity;      // [0, 1]
};

template <MaybeConst<TriangleWindows> Kernel>
void for_each_column(Kernel& kernel, auto&& act) {
  act(Column{kernel.corners, "corner", 3, ColumnRole::corner, ColumnRange::finite});
  act(Column{kernel.sigma, "sigma", 1, ColumnRole::value, ColumnRange::positive});
  act(Column{kernel.opacity, "opacity", 1, ColumnRole::opacity, ColumnRange::fraction});
}

/// Mean coverage of a triangle window: opacity * 2 / ((sigma+1)(sigma+2)). The factor after opacity
/// is the mean of rho^sigma over the triangle.
inline double mean_coverage(double opacity, double sigma) {
  return opacity * 2.0 / ((sigma + 1.0) * (sigma + 2.0));
}

// One splat, for splats.hpp, splat_limit.hpp and lint.hpp.

inline const char* kernel_name(const TriangleWindows&) { return "triangle windows"; }

inline void add_to_box(const TriangleWindows& windows, std::size_t i, float min_alpha,
                       SplatBox& box) {
  if (windows.opacity[i] >= min_alpha)
    for (std::size_t corner = 0; corner < 3; ++corner) box.add(windows.corners[3 * i + corner]);
}

inline double contribution(const TriangleWindows& windows, std::size_t i) {
  const glm::dvec3 a = windows.corners[3 * i], b = windows.corners[3 * i + 1],
                   c = windows.corners[3 * i + 2];
  return mean_coverage(double(windows.opacity[i]), double(windows.sigma[i])) *
         glm::length(glm::cross(b - a, c - a));
}

/// The longest edge, and the height over it.
inline SplatSize size_of(const TriangleWindows& windows, std::size_t i) {
  const glm::vec3* corner = &windows.corners[3 * i];
  const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
  const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  const double doubled_area = glm::length(glm::cross(b - a, c - a));
  // As for faces: far below any intended area.
  const bool is_degenerate = doubled_area <= 1e-12 * longest * longest;
  return {longest, longest > 0 ? doubled_area / longest : 0, is_degenerate};
}

}  // namespace tureen
