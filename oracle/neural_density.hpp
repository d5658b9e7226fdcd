// A neural density (scene/splats.hpp) along a ray. Source: Splat the Net (arXiv 2510.08491). With a
// ray x(t) = o + t d, |d| = 1, and the chord of the ellipsoid with midpoint m and half-length h, in
// units of the largest semi-axis s:
//   optical depth = 2 h / s (b2 + sum_k a_k sinc(b_k h) cos(phase of neuron k at the midpoint)),
// where b_k = omega w_k . d / s and sinc(x) = sin(x) / x. This is the integral in closed form; the
// difference of its antiderivatives cancels for small b_k. alpha = 1 - exp(-optical depth).
//
// All of it is computed in layer coordinates, so networks stay as they are when a layer moves.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "oracle/splat_sample.hpp"
#include "oracle/splat_view.hpp"

namespace tureen::oracle {

class NeuralDensityInView {
 public:
  /// Density `i`, or nullopt if no pixel can show it. `view` must outlive the result.
  static std::optional<NeuralDensityInView> project(const NeuralDensities& densities, std::size_t i,
                                                    const SplatProfile& profile,
                                                    const SplatView& view);

  /// The optical depth along the ray between two depths in world units; 0 or less: nothing is
  /// visible. `middle_depth` is set to the depth at the middle of the part that is integrated.
  double optical_depth(const glm::dvec2& pixel, double from, double to, double& middle_depth) const;
  /// Depth and order are those at the middle of the chord between the near plane and
  /// `opaque_depth`.
  SplatSample at(const glm::dvec2& pixel, double opaque_depth) const;
  const ImageBox& box() const { return box_; }

 private:
  static constexpr int width = NeuralDensities::width;

  glm::dvec3 center_to_eye_;      // in layer coordinates
  glm::dmat3 sphere_from_layer_;  // S^-1 R^T: the ellipsoid becomes the unit sphere
  double largest_axis_ = 1;
  std::array<glm::dvec3, width> frequencies_;  // times omega
  std::array<double, width> phases_;           // times omega
  std::array<double, width> amplitudes_;
  double offset_ = 0;
  const SplatView* view_ = nullptr;
  SplatProfile profile_;
  ImageBox box_;
};

/// Declared only: the class that splat_kernels.cpp uses for this kernel.
NeuralDensityInView in_view(const NeuralDensities&);

}  // namespace tureen::oracle
