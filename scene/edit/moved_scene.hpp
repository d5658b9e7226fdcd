// A whole scene in another place: all layers, the cameras and the first view.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.hpp"

namespace tureen {

/// Moves everything in the scene by a similarity of the world (defect() of a Layer accepts it). The
/// up axis stays; distances in a splat's profile do, too. Cameras see the same images: a mirror
/// mirrors their positions and lines of sight, and they stay right-handed. O(layers + cameras).
void move_scene(Scene& scene, const glm::dmat4& world_from_world);

/// Turns the scene by rotation_between() its up axis and `up`, and adds a remark; nothing if they
/// differ by less than 1e-6, which is the rounding of axes in floats.
void turn_upright(Scene& scene, const glm::vec3& up);

}  // namespace tureen
