// Gaussians and flat Gaussians (discs).
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/kernels/column.hpp"

namespace tureen {

/// 3D Gaussian Splatting, and with `flat` the discs of 2DGS, GaMeS and REdiSplats (arXiv
/// 2503.12284). alpha = opacity * exp(-q / 2), where q is the squared distance from the centre in
/// standard deviations; SplatProfile::projection says where it is measured.
struct Gaussians {
  std::vector<glm::vec3> centers = {};
  /// Standard deviations along the local axes, in layer units, >= 0. Discs span the local x and y
  /// axes; their z is not used.
  std::vector<glm::vec3> scales = {};
  std::vector<glm::quat> rotations = {};  // of unit length: layer from local coordinates
  std::vector<float> opacity = {};        // [0, 1]
  bool flat = false;
};

template <MaybeConst<Gaussians> Kernel>
void for_each_column(Kernel& kernel, auto&& act) {
  act(Column{kernel.centers, "centre", 1, ColumnRole::position, ColumnRange::finite});
  act(Column{kernel.scales, "scale", 1, ColumnRole::scale, ColumnRange::not_negative});
  act(Column{kernel.rotations, "rotation", 1, ColumnRole::rotation, ColumnRange::unit_length});
  act(Column{kernel.opacity, "opacity", 1, ColumnRole::opacity, ColumnRange::fraction});
}

// One splat, for splats.hpp, splat_limit.hpp and lint.hpp.

inline const char* kernel_name(const Gaussians& gaussians) {
  return gaussians.flat ? "flat Gaussians" : "Gaussians";
}

inline void add_to_box(const Gaussians& gaussians, std::size_t i, float min_alpha, SplatBox& box) {
  const double squared = 2 * std::log(double(gaussians.opacity[i]) / double(min_alpha));
  if (!(squared >= 0)) return;
  glm::dvec3 axes(gaussians.scales[i]);
  if (gaussians.flat) axes.z = 0;
  box.add(gaussians.centers[i], gaussians.rotations[i], std::sqrt(squared) * axes);
}

inline double contribution(const Gaussians& gaussians, std::size_t i) {
  return double(gaussians.opacity[i]) * largest_section(gaussians.scales[i]);
}

inline SplatSize size_of(const Gaussians& gaussians, std::size_t i) {
  glm::dvec3 axes(gaussians.scales[i]);
  if (gaussians.flat) axes.z = std::min(axes.x, axes.y);  // only these two have an extent
  return SplatSize::of_ellipsoid(axes);
}

}  // namespace tureen
