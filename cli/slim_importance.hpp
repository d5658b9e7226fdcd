// What errors of a soup's texels show, and the steps that follow from it: the part of the search
// for a slim file (cli/slim.hpp) that stays the same while the step of colour changes.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/slim_texels.hpp"
#include "runtime/gl/context.hpp"
#include "soup/camera.hpp"
#include "soup/feature_sensitivity.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen::cli {

class SlimImportance {
 public:
  /// Of a soup with a lattice texture, which must outlive it, as these views (at least one) show
  /// it.
  SlimImportance(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                 std::span<const Camera> views);

  /// How texels are coded in steps of so many 255ths of colour in the mean (slim_basis).
  SlimTexelOptions options(double step, std::uint8_t alpha_step) const;

  /// Texels of which no pixel of the views takes anything.
  std::size_t unseen_texels() const { return unseen_texels_; }

 private:
  const LatticeTexture& texture_;
  FeatureMatrix sensitivity_{};
  std::vector<std::uint8_t> coarseness_;  // of faces
  std::vector<float> weights_;            // of texels
  std::size_t unseen_texels_ = 0;
};

}  // namespace tureen::cli
