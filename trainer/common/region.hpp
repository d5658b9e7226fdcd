// The region of interest of a dataset: what its cameras look at, and how large that is. Lengths of
// training are in units of it (Config), random points begin in it.
#pragma once

#include <glm/vec3.hpp>

#include "scene/photographs.hpp"

namespace tureen::trainer {

/// An axis-parallel cube in world coordinates.
struct Region {
  glm::dvec3 centre{0.0};
  double half_side = 1.0;
};

/// Of the training cameras and points.
///
/// Where the optical axes meet, the centre is the point nearest to all of them (least squares), and
/// the half side is what a camera's image shows at its depth, from the middle to the nearer
/// border; the median over the cameras. NeRF-synthetic lego: 1.45 around the origin, nearly.
/// Where they do not meet (parallel axes, cameras that look outwards) points decide, if there are
/// any: their median and the median distance from it. Else the cameras must: outward ones stand in
/// the middle of a region of twice their extent; parallel ones look at a distance of eight times
/// theirs. Throws InputError when nothing gives a scale: one camera, or all at one place.
Region region_of_interest(const Dataset& dataset);

}  // namespace tureen::trainer
