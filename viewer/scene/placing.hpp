// Places of layers that need no numbers: on the ground, and in the middle.
#pragma once

#include "viewer/scene/scene_source.hpp"

namespace tureen::viewer {

/// The place at which the layer's lowest point along `up` (of unit length) is at height 0. Points
/// are the corners of the triangles or the centres of the splats in its box, so that strays do not
/// count. O(points).
glm::dmat4 on_the_ground(const DocumentLayer& layer, const glm::dvec3& up);

/// The place at which the middle of its box is at the origin.
glm::dmat4 in_the_middle(const DocumentLayer& layer);

}  // namespace tureen::viewer
