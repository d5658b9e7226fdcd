// A flat Gaussian (scene/splats.hpp) on its own plane, exactly: q = u^2 + v^2, where (u, v) is the
// intersection of the pixel's ray with the disc's plane, in standard deviations from the centre.
// Sources: 2D Gaussian Splatting (arXiv 2403.17888), equations 8 to 11; REdiSplats (arXiv
// 2503.12284), equation 14 without the normal axis.
//
// The intersection exists where its depth is at least the near distance. LowPass::screen uses the
// smaller of q and the squared distance in the image from the centre's image, in units of
// screen_variance. Where the ray has no intersection, only this filter remains: a disc seen edge-on
// becomes a round dot. (The code of 2DGS skips pixels whose intersection is nearer than the near
// plane; there alpha would be discontinuous.)
#pragma once

#include <cstddef>
#include <optional>

#include "oracle/splat_sample.hpp"
#include "oracle/splat_view.hpp"

namespace tureen::oracle {

class DiscInView {
 public:
  /// Disc `i`, or nullopt if no pixel can show it. With LowPass::screen, a centre at or behind the
  /// near plane is not drawn; without, all of the disc beyond the near plane is. `view` must
  /// outlive the result.
  static std::optional<DiscInView> project(const Gaussians& gaussians, std::size_t i,
                                           const SplatProfile& profile, const SplatView& view);

  /// Depth and order are those of the plane at the pixel, or of the centre where the low pass has
  /// the smaller q, as in 2DGS.
  SplatSample at(const glm::dvec2& pixel) const;
  const ImageBox& box() const { return box_; }

 private:
  glm::dvec3 center_, u_axis_, v_axis_;  // in view coordinates; axes as long as one deviation
  glm::dvec2 center_image_;              // only with LowPass::screen
  double opacity_ = 0;
  const SplatView* view_ = nullptr;
  SplatProfile profile_;
  std::optional<ImageBox> tiles_;  // the only ones that show it; nullopt: all
  ImageBox box_;
};

}  // namespace tureen::oracle
