// The depth range of a frame, computed from the scene. It clips little and wastes little depth
// precision on empty space. The oracle uses the range for reversed depth.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "scene/camera.hpp"
#include "scene/layer_place.hpp"

namespace tureen {

struct ClipRange {
  double near = 0;
  double far = 0;
};

/// The storage of depth determines the smallest distance from the eye to the near plane.
enum class DepthStorage {
  /// Precision falls in proportion to far / near; near is at least a thousandth of the scene's
  /// radius.
  fixed_24,
  /// Precision does not depend on the near plane; near is at least a billionth of the radius.
  reversed_float,
};

/// `eye` is in the coordinates of the bounds. `forward` is the viewing axis, of unit length; depth
/// is measured along it, so off-axis points have a depth below their distance. The result satisfies
/// 0 < near < far for every finite input. Geometry nearer than `near` is clipped. Nothing is
/// clipped if the bounds lie entirely in front of the eye and beyond the smallest `near` of the
/// storage.
ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, glm::dvec3 forward,
                     DepthStorage storage);

/// The range of a frame that draws all these layers, hidden ones too, with one depth buffer, in
/// world units: from the smallest `near` of a layer to the largest `far`. A distant or enormous
/// layer thus does not clip the others; with DepthStorage::fixed_24, a small layer near the eye
/// makes the depth of the others coarser. Beside others, layers behind the eye are ignored, and
/// layers without extent: they contain nothing visible, and the box of an empty layer lies at an
/// arbitrary place. Without layers, the range has no meaning, but is valid. For one layer that is
/// only translated, the result equals clip_range(bounds, eye - translation, forward, storage) bit
/// for bit.
ClipRange clip_range(std::span<const LayerPlace> layers, const Camera& camera,
                     DepthStorage storage);

/// The viewing axis in world coordinates.
glm::dvec3 forward_of(const Camera& camera);

/// The distance along the viewing axis of a stored depth: the inverse of clip_from_view and
/// clip_from_view_reversed (scene/camera.hpp). Returns nullopt for the background's depth.
std::optional<double> distance_of(double stored, const ClipRange& range, DepthStorage storage);

}  // namespace tureen
