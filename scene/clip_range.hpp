// The depth range of a frame, chosen from the scene so that little is clipped and little depth
// precision is spent on empty space. The oracle uses that of reversed depth.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct ClipRange {
  double near = 0;
  double far = 0;
};

/// How depth is stored decides how near the near plane may come to an eye within the scene.
enum class DepthStorage {
  fixed_24,        // precision is lost in proportion to far / near: a thousandth of the radius
  reversed_float,  // precision does not depend on the near plane: a billionth
};

/// `eye` is relative to the soup's origin, `forward` the viewing axis, of unit length: planes of
/// depth are perpendicular to it, so what lies far off the axis is nearer than it is away.
/// 0 < near < far for every finite input. What lies nearer than `near` is clipped; where the bounds
/// lie in front of the eye, nothing does.
ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, glm::dvec3 forward,
                     DepthStorage storage);

/// The viewing axis in world coordinates.
glm::dvec3 forward_of(const Camera& camera);

/// How far along the viewing axis a stored depth lies, the inverse of clip_from_view and
/// clip_from_view_reversed (scene/camera.hpp); nothing for that of the background.
std::optional<double> distance_of(double stored, const ClipRange& range, DepthStorage storage);

}  // namespace tureen
