// How visible errors in a soup's texels are, and the quantisation steps that follow from it. The
// constructor measures once; options() then gives the steps for any step of colour
// (jobs/compress/compress.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/tureen_glb/compressed_texels.hpp"
#include "runtime/gl/context.hpp"
#include "scene/camera.hpp"
#include "scene/edit/feature_sensitivity.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

class CompressImportance {
 public:
  /// Measures a soup with a lattice texture, which must outlive this object, in these views (at
  /// least one). Unless `by_texel` is set, all texels of a face have the same weight. `cancel` is
  /// called often and may throw.
  CompressImportance(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                     std::span<const Camera> views, bool by_texel,
                     const std::function<void()>& cancel);

  /// Options for which one quantisation step changes the colour by `step` / 255 on average
  /// (compressed_basis.hpp). Without a bit price each value is rounded to its nearest step.
  CompressedTexelOptions options(double step, std::uint8_t alpha_step,
                                 bool bits_have_a_price) const;

  /// Number of texels that no pixel of the views uses; they have a lower weight.
  std::size_t unseen_texels() const { return unseen_texels_; }

 private:
  const LatticeTexture& texture_;
  FeatureMatrix sensitivity_{};
  std::vector<std::uint8_t> coarseness_;  // of each face
  std::vector<float> weights_;            // of each texel
  std::size_t unseen_texels_ = 0;
};

}  // namespace tureen
