// What a point of a face looks like, in double precision: whether a fragment exists there and its
// colour, for every appearance of scene/triangle_soup.hpp.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "scene/triangle_soup.hpp"

namespace tureen::oracle {

/// A point of a face. The barycentrics may leave [0, 1] a little: lattices are then sampled at the
/// point of the face that simplex.glsl has for them, everything else is extrapolated as GL's
/// interpolators do.
struct SurfacePoint {
  std::uint32_t face = 0;
  double b0 = 0, b1 = 0;  // weights of vertices 0 and 1
};

/// Whether a fragment exists: the appearance's alpha rule. NaN is no fragment.
bool is_visible(const TriangleSoup& soup, const SurfacePoint& point);

/// The display-referred colour, clamped to [0, 1] as any image holds it; NaN becomes 0. `to_eye`
/// is the unit direction from the point to the eye, which color MLPs see; `eye` is the eye relative
/// to the soup's origin, from which harmonics take the directions of centroids and vertices. A
/// centroid or vertex at the eye itself is seen along (0, 0, 1) (docs/numerics.md, V5).
glm::dvec3 color(const TriangleSoup& soup, const SurfacePoint& point, glm::dvec3 to_eye,
                 glm::dvec3 eye);

}  // namespace tureen::oracle
