// One mean colour a face, for formats and viewers without other appearances. Deterministic: the
// same soup gives the same bytes on every run.
//
// The mean is over:
// - directions: the 26 points of Lebedev's quadrature of order 7 with its weights, exact for
//   harmonics up to degree 4 that never clamp. The rule is symmetric in d and -d, so the view
//   convention does not matter. Faces are seen from both sides.
// - the face's area: a lattice texel is weighted by the area of its hat function, and only if it is
//   visible (alpha >= alpha_threshold). UV textures and cut-out vertex colours are sampled at the
//   centroids of a regular 16-fold subdivision, images by their nearest texel.
// A face without visible points gets the mean over all of it.
//
// With a color MLP at most `mlp_samples` visible texels of a face are evaluated, evenly spaced in
// their order: 15,000 faces at level 5 take about 2 s on one core.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

inline constexpr int mlp_samples = 16;

/// Display-referred sRGB in [0, 1], one a face. The soup has no defect().
std::vector<glm::vec3> mean_colors(const TriangleSoup& soup);

}  // namespace tureen
