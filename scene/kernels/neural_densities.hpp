// Neural densities: ellipsoids with a small network each.
#pragma once

#include "scene/kernels/column.hpp"

namespace tureen {

/// Splattable neural primitives (arXiv 2510.08491): ellipsoids with the density
/// b2 + sum_k a_k cos(omega (w_k . u + b1_k)), u = (point - centre) / largest semi-axis, not
/// rotated. alpha = 1 - exp(-optical depth), where the optical depth is the integral of the density
/// along the ray's chord, in units of the largest semi-axis; below 0 it is 0.
struct NeuralDensities {
  static constexpr int width = 8;                           // neurons
  static constexpr std::size_t parameters = 5 * width + 1;  // a splat
  std::vector<glm::vec3> centers;
  std::vector<glm::vec3> semi_axes;  // along the local axes, in layer units, > 0
  std::vector<glm::quat> rotations;  // of unit length: layer from local coordinates
  /// `parameters` values per splat: w_0.xyz, w_1.xyz, .. w_7.xyz, b1_0 .. b1_7, a_0 .. a_7, b2.
  std::vector<float> networks;
  float omega = 30;
};

template <MaybeConst<NeuralDensities> Kernel>
void for_each_column(Kernel& kernel, auto&& act) {
  act(Column{kernel.centers, "centre", 1, ColumnRole::position, ColumnRange::finite});
  act(Column{kernel.semi_axes, "semi-axis", 1, ColumnRole::scale, ColumnRange::positive});
  act(Column{kernel.rotations, "rotation", 1, ColumnRole::rotation, ColumnRange::unit_length});
  act(Column{kernel.networks, "network", NeuralDensities::parameters, ColumnRole::value,
             ColumnRange::finite});
}

// One splat, for splats.hpp, splat_limit.hpp and lint.hpp.

inline const char* kernel_name(const NeuralDensities&) { return "neural densities"; }

inline void add_to_box(const NeuralDensities& densities, std::size_t i, float, SplatBox& box) {
  box.add(densities.centers[i], densities.rotations[i], densities.semi_axes[i]);
}

inline double contribution(const NeuralDensities& densities, std::size_t i) {
  return largest_section(densities.semi_axes[i]);
}

inline SplatSize size_of(const NeuralDensities& densities, std::size_t i) {
  return SplatSize::of_ellipsoid(densities.semi_axes[i]);
}

}  // namespace tureen
