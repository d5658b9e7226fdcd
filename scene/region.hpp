// The region of interest of a dataset: the part of the scene that its cameras look at. It is the
// unit of training lengths (Config). Random initial points lie in it.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "scene/camera.hpp"
#include "scene/photographs.hpp"

namespace tureen {

/// An axis-parallel cube in world coordinates.
struct Region {
  glm::dvec3 center{0.0};
  double half_side = 1.0;
};

/// The region for the training cameras and points, from the first of these that applies:
///
/// 1. The optical axes meet in front of most cameras: the centre is the point nearest to all axes
///    (least squares). A camera's half side is the extent of its image at that depth, from the
///    middle to the nearer border; the result is the median over the cameras. NeRF-synthetic lego:
///    about 1.45 around the origin.
/// 2. The dataset has points: their median, and the median distance from it.
/// 3. The cameras look outwards: their mean position, and twice their extent; 1 if they are all at
///    one position.
/// 4. The cameras are parallel: the centre lies ahead of them at eight times their extent, and the
///    half side is computed as in case 1. If they are all at one position, for example with a
///    single camera, the images give no scale: the half side is 1, and the centre lies at the depth
///    where the image (the median over the cameras) has this half side.
///
/// Throws InputError if there is no training view, or the region is not finite.
Region region_of_interest(const Dataset& dataset);

/// The same for cameras without points (cases 1, 3 and 4); nullopt without cameras, and if the
/// region is not finite.
std::optional<Region> region_of_cameras(std::span<const Camera> cameras);

/// The point that the cameras look at: the least sum of distances to their optical axes, so that a
/// few cameras that look elsewhere hardly move it. nullopt if the axes do not determine it, or if
/// it is behind half of the cameras or more. Least squares, weighted anew ten times.
std::optional<glm::dvec3> looked_at_point(std::span<const Camera> cameras);

}  // namespace tureen
