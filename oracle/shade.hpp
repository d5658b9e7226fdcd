// The appearance of a point on a face, in double precision, for every kind in
// scene/triangle_soup.hpp: the existence of a fragment and its colour.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "scene/triangle_soup.hpp"

namespace tureen::oracle {

/// A point on a face. The barycentrics may leave [0, 1] slightly. Lattices are then sampled at the
/// point on the face that simplex.glsl uses; other values are extrapolated as GL's interpolators
/// do.
struct SurfacePoint {
  std::uint32_t face = 0;
  double b0 = 0, b1 = 0;  // weights of vertices 0 and 1
};

/// Whether a fragment exists, by the alpha rule of the appearance. NaN gives no fragment.
bool is_visible(const TriangleSoup& soup, const SurfacePoint& point);

/// The display-referred colour, clamped to [0, 1]; NaN becomes 0. `to_eye` is the unit direction
/// from the point to the eye, for color MLPs. `eye` is the eye relative to the soup's origin, for
/// the harmonics at centroids and vertices. A centroid or vertex exactly at the eye uses the
/// direction (0, 0, 1) (docs/numerics.md, V5).
glm::dvec3 color(const TriangleSoup& soup, const SurfacePoint& point, glm::dvec3 to_eye,
                 glm::dvec3 eye);

}  // namespace tureen::oracle
