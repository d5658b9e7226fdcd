// One colour a face: what the face looks like in the mean, for formats and viewers that know no
// more than that. Deterministic; the same soup gives the same bytes on every run.
//
// What is averaged:
// - directions: the 26 points of Lebedev's quadrature of order 7 with its weights, so that
//   harmonics up to degree 4 that never clamp are averaged exactly; it holds d and -d alike, so
//   the view convention does not matter. Faces are seen from both sides.
// - a face's own area: a lattice texel counts by the area of its hat function, and only if it is
//   visible (alpha >= alpha_threshold); UV textures and cut-out vertex colours are sampled at the
//   centroids of a regular 16-fold subdivision, images by their nearest texel.
// A face of which nothing is visible gets the mean of all of it.
//
// Where a color MLP shades, at most `mlp_samples` of a face's visible texels are evaluated, evenly
// spread over their order: 15,000 faces at level 5 take about two seconds on one core.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

inline constexpr int mlp_samples = 16;

/// Display-referred sRGB in [0, 1], one a face. The soup has no defect().
std::vector<glm::vec3> mean_colors(const TriangleSoup& soup);

}  // namespace tureen
