// The depth range of a frame, computed from the scene. It clips little and wastes little depth
// precision on empty space. The oracle uses the range for reversed depth.
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

/// The storage of depth limits how close the near plane may be to an eye inside the scene.
enum class DepthStorage {
  /// Precision falls in proportion to far / near; near is at least a thousandth of the scene's
  /// radius.
  fixed_24,
  /// Precision does not depend on the near plane; near is at least a billionth of the radius.
  reversed_float,
};

/// `eye` is relative to the soup's origin. `forward` is the viewing axis, of unit length; depth is
/// measured along it, so off-axis points have a depth below their distance. The result satisfies 0
/// < near < far for every finite input. Geometry nearer than `near` is clipped. If the bounds lie
/// entirely in front of the eye, nothing is clipped.
ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, glm::dvec3 forward,
                     DepthStorage storage);

/// The viewing axis in world coordinates.
glm::dvec3 forward_of(const Camera& camera);

/// The distance along the viewing axis of a stored depth: the inverse of clip_from_view and
/// clip_from_view_reversed (scene/camera.hpp). Returns nullopt for the background's depth.
std::optional<double> distance_of(double stored, const ClipRange& range, DepthStorage storage);

}  // namespace tureen
