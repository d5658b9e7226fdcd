#include "scene/clip_range.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tureen {

ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, glm::dvec3 forward,
                     DepthStorage storage) {
  // A soup that is a single point still needs a range.
  const double radius = std::max(bounds.radius(), 1e-6);
  const double depth = glm::dot(bounds.centre() - eye, forward);
  // From within the scene 24 bits of ordinary depth tell apart surfaces 1e-4 radii apart at the far
  // side when the near plane comes no closer than a thousandth of the radius (docs/numerics.md,
  // D1). One stray face far away makes that thousandth large. Reversed float depth is as fine with
  // any near plane, and a corner next to the eye is known as finely as it is near: a billionth
  // leaves what is at 1 to be seen where something lies at 1e8.
  const double least = storage == DepthStorage::reversed_float ? 1e-9 : 1e-3;
  // 5 % of slack on both sides covers rounding. Behind the eye there is nothing to be seen, and any
  // range will do.
  const double near = std::max(0.95 * (depth - radius), least * radius);
  return {near, std::max(1.05 * (depth + radius), 2 * near)};
}

glm::dvec3 forward_of(const Camera& camera) { return -camera.world_from_view_rotation()[2]; }

std::optional<double> distance_of(double stored, const ClipRange& range, DepthStorage storage) {
  if (storage == DepthStorage::reversed_float)
    return stored > 0 ? std::optional(range.near / stored) : std::nullopt;
  if (stored >= 1) return std::nullopt;
  return range.near * range.far / (range.far - stored * (range.far - range.near));
}

}  // namespace tureen
