// A triangle window (scene/splats.hpp) in the image of a camera. Source: Triangle Splatting (arXiv
// 2505.19175), section 3, in a homogeneous form that needs no vertex in front of the eye:
//
// With Q_k = (x_k w_k, y_k w_k, w_k) in pixels from the principal point, N_k = Q_i x Q_j for the
// edge ij opposite k, and W = sum_k w_k |N_k.xy|, let g be the vector that has W / |N_k.xy| as its
// component k at vertex k and 0 elsewhere, interpolated perspective-correctly. g / w at the pixel
// holds the distances from the three edges, divided by the inradius, and
//   rho = clamp(min(g_0, g_1, g_2) / w, 0, 1).
// With D = Q_0 . (Q_1 x Q_2), component k of g / w is W (p . N_k) / (|N_k.xy| D) at the image point
// p, because p . N_k / D is the barycentric divided by w.
//
// If all vertices are in front of the eye, |N_k.xy| = w_i w_j |edge| and |D| = w_0 w_1 w_2 2 area:
// W / |D| is one over the inradius. With one vertex behind the eye, rho continues as the distance
// over the radius of the excircle. With W <= 0 nothing is drawn.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "oracle/splat_sample.hpp"
#include "oracle/splat_view.hpp"

namespace tureen::oracle {

class WindowInView {
 public:
  /// Window `i`, or nullopt if no pixel can show it.
  static std::optional<WindowInView> project(const TriangleWindows& windows, std::size_t i,
                                             const SplatProfile& profile, const SplatView& view);

  /// rho, or 0 where the window does not exist: outside, or nearer than the near plane.
  double rho(const glm::dvec2& pixel) const;
  /// Barycentrics of the image point among the images of the corners. The barycentric of corner k
  /// is w_k (p . N_k) / D times the depth at p; with k behind the eye, 0 takes its place, and the
  /// others are scaled to the sum 1. Defined where rho() is above 0.
  std::array<double, 3> corner_weights(const glm::dvec2& pixel) const;
  /// Depth and order are those of the triangle's plane.
  SplatSample at(const glm::dvec2& pixel) const;
  const ImageBox& box() const { return box_; }

 private:
  double depth(const glm::dvec2& from_principal_point) const;
  /// p . N_k.
  double edge_product(int k, const glm::dvec2& from_principal_point) const;

  std::array<glm::dvec3, 3> start_, edge_;  // N_k = start_[k] x edge_[k]
  std::array<double, 3> scale_;             // W / (|N_k.xy| D)
  std::array<double, 3> corner_depths_;     // w_k
  glm::dvec3 normal_;                       // N_0 + N_1 + N_2: w = D / (p . normal)
  double determinant_ = 0;                  // D
  double sigma_ = 1, opacity_ = 0, near_ = 0;
  glm::dvec2 principal_point_;
  SplatProfile profile_;
  ImageBox box_;
};

/// Declared only: the class that splat_kernels.cpp uses for this kernel.
WindowInView in_view(const TriangleWindows&);

}  // namespace tureen::oracle
