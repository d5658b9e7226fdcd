// Neural densities: ellipsoids with a small network each.
#pragma once

#include <algorithm>
#include <cmath>

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

template <MaybeConst<NeuralDensities> Kernel>
void for_each_constant(Kernel& kernel, auto&& act) {
  act("omega", kernel.omega);
}

/// The frequencies are vectors in layer coordinates.
inline void turn_values(NeuralDensities& densities, const glm::dmat3& turn) {
  for (std::size_t i = 0; i < densities.networks.size(); i += NeuralDensities::parameters)
    for (std::size_t k = i; k < i + 3 * std::size_t(NeuralDensities::width); k += 3) {
      float* w = &densities.networks[k];
      const glm::vec3 moved(turn * glm::dvec3(w[0], w[1], w[2]));
      for (int axis = 0; axis < 3; ++axis) w[axis] = moved[axis];
    }
}

/// The opacity of splat `i` for programs without this kernel: that of a sphere with the constant
/// part of the density, along its diameter of 2.
inline float plain_opacity(const NeuralDensities& densities, std::size_t i) {
  const float constant = densities.networks[NeuralDensities::parameters * (i + 1) - 1];
  return static_cast<float>(1.0 - std::exp(-2.0 * std::max(double(constant), 0.0)));
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
