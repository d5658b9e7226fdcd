// What errors of a soup's texels show, and the steps that follow from it: the part of the search
// for a slim file (jobs/compress/slim.hpp) that stays the same while the step of colour changes.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/tureen_glb/slim_texels.hpp"
#include "runtime/gl/context.hpp"
#include "scene/camera.hpp"
#include "scene/edit/feature_sensitivity.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

class SlimImportance {
 public:
  /// Of a soup with a lattice texture, which must outlive it, as these views (at least one) show
  /// it. Unless `by_texel` the texels of a face weigh alike, whichever of them show. `cancel` is
  /// called often and may throw.
  SlimImportance(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                 std::span<const Camera> views, bool by_texel, const std::function<void()>& cancel);

  /// How texels are coded in steps of so many 255ths of colour in the mean (slim_basis). Where bits
  /// have no price, each value comes as near as its step allows.
  SlimTexelOptions options(double step, std::uint8_t alpha_step, bool bits_have_a_price) const;

  /// Texels of which no pixel of the views takes anything, and which weigh less for it.
  std::size_t unseen_texels() const { return unseen_texels_; }

 private:
  const LatticeTexture& texture_;
  FeatureMatrix sensitivity_{};
  std::vector<std::uint8_t> coarseness_;  // of faces
  std::vector<float> weights_;            // of texels
  std::size_t unseen_texels_ = 0;
};

}  // namespace tureen
