#include "scene/clip_range.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tureen {

ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, glm::dvec3 forward,
                     DepthStorage storage) {
  // A soup with a single point also needs a range.
  const double radius = std::max(bounds.radius(), 1e-6);
  const double depth = glm::dot(bounds.centre() - eye, forward);
  // For an eye inside the scene and a near plane at a thousandth of the radius, 24-bit depth
  // separates surfaces 1e-4 radii apart at the far side (docs/numerics.md, D1). One stray face far
  // away makes that thousandth large. The precision of reversed float depth does not depend on the
  // near plane, and vertices near the eye are precise in proportion to their distance. With a
  // billionth, geometry at distance 1 stays visible in a scene that extends to 1e8.
  const double least = storage == DepthStorage::reversed_float ? 1e-9 : 1e-3;
  // A slack of 5 % on both sides covers rounding. If the scene lies behind the eye, nothing is
  // visible and any range is valid.
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
