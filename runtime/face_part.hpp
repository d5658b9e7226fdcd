// What need be drawn of a cut-out face: a smaller triangle of the same shape that contains all that
// exists of it. What lies around it would be rasterised only to fail the alpha test
// (docs/leaving-out.md, O4).
#pragma once

#include <cstdint>

#include "runtime/plan.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen {

/// How far, in barycentrics, the edges of a part stay from whatever exists.
///
/// The rasteriser moves a corner by at most half of 1/256 pixel along each axis, so an edge by less
/// than 0.003 pixels. On a face more than 0.4 pixels high the margin is wider than that, and no
/// fragment is lost; a flatter one covers the centre of a pixel only by chance.
inline constexpr double part_margin = 1.0 / 128.0;

/// The whole face, as a part of itself.
inline constexpr FacePart whole_face = {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(0, 0)};

/// The part of `face` that need be drawn, its corners in the order of the face's vertices. The
/// whole face where what exists comes within the margin of one of its edges: there the rasteriser
/// must see the very edge that the neighbours have. Also where alphas are so large, or the face so
/// small for its distance from the origin, that rounding would have a say. O(texels of the face).
FacePart existing_part(const TriangleSoup& soup, const LatticeTexture& texture, std::uint32_t face);

/// Of a part, as a share of the face.
double area_share(const FacePart& part);

}  // namespace tureen
