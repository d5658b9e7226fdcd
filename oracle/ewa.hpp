// A Gaussian (scene/splats.hpp) in the image of a camera, by the affine approximation of the
// projection at its centre. Sources: EWA Splatting (Zwicker et al. 2001), equations 29 to 31; 3D
// Gaussian Splatting (arXiv 2308.04079), equation 5; Mip-Splatting (arXiv 2311.16493), section 5.2.
//
// With the Jacobian J of the projection at the centre, W the linear part of view from layer, R the
// rotation and S the scales, the covariance in the image is M M^T, M = J W R S, in px^2. A low pass
// adds dilation_variance to both variances; LowPass::mip also multiplies the opacity by
// sqrt(det before / det after). alpha = opacity exp(-q / 2), q = d^T (covariance)^-1 d, where d is
// the offset from the centre's image.
//
// J is evaluated at x/z and y/z of the centre, limited to the image widened by 15 % of its size at
// each side. For a principal point at the image centre this equals the limit of 3DGS, 1.3
// tan(fov / 2) on both sides; 3DGS has no other principal point.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "oracle/splat_sample.hpp"
#include "oracle/splat_view.hpp"

namespace tureen::oracle {

class EwaInView {
 public:
  /// Gaussian `i`, or nullopt if no pixel can show it. A centre at or behind the near plane is not
  /// drawn, nor a Gaussian without extent in the image (possible only without a low pass). Flat
  /// Gaussians have scale 0 along z.
  static std::optional<EwaInView> project(const Gaussians& gaussians, std::size_t i,
                                          const SplatProfile& profile, const SplatView& view);

  /// q at an image point.
  double squared_distance(const glm::dvec2& pixel) const;
  /// The depth is that of the centre. The order is the depth of the largest density along the ray,
  /// but at least the near distance.
  SplatSample at(const glm::dvec2& pixel) const;
  const ImageBox& box() const { return box_; }

  const glm::dvec2& center() const { return center_; }
  /// The opacity after the compensation of LowPass::mip.
  double opacity() const { return opacity_; }

 private:
  double depth_of_largest_density(const glm::dvec3& ray) const;

  glm::dvec2 center_;
  /// The lower triangular factor of the covariance: (l11, 0; l21, l22).
  double l11_ = 0, l21_ = 0, l22_ = 0;
  double opacity_ = 0;
  glm::dvec3 center_in_view_;
  std::array<glm::dvec3, 3> axes_;   // in view coordinates, all of one length
  std::array<double, 3> sharpness_;  // smallest scale / scale; 1 for scales of 0
  double near_ = 0;
  const SplatView* view_ = nullptr;
  SplatProfile profile_;
  std::optional<ImageBox> tiles_;  // the only ones that show it; nullopt: all
  ImageBox box_;
};

/// Declared only: the class that splat_kernels.cpp uses for this kernel unless the profile projects
/// them on their plane.
EwaInView in_view(const Gaussians&);

}  // namespace tureen::oracle
