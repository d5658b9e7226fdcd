// The region of interest of a dataset: the part of the scene that its cameras look at. It is the
// unit of training lengths (Config). Random initial points lie in it.
#pragma once

#include <glm/vec3.hpp>

#include "scene/photographs.hpp"

namespace tureen::trainer {

/// An axis-parallel cube in world coordinates.
struct Region {
  glm::dvec3 centre{0.0};
  double half_side = 1.0;
};

/// The region for the training cameras and points, from the first of these that applies:
///
/// 1. The optical axes meet in front of most cameras: the centre is the point nearest to all axes
///    (least squares). A camera's half side is the extent of its image at that depth, from the
///    middle to the nearer border; the result is the median over the cameras. NeRF-synthetic lego:
///    about 1.45 around the origin.
/// 2. The dataset has points: their median, and the median distance from it.
/// 3. The cameras look outwards: their mean position, and twice their extent.
/// 4. The cameras are parallel: the centre lies ahead of them at eight times their extent, and the
///    half side is computed as in case 1.
///
/// Throws InputError if nothing determines a scale: one camera, or all cameras at one position.
Region region_of_interest(const Dataset& dataset);

}  // namespace tureen::trainer
