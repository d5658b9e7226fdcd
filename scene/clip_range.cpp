#include "scene/clip_range.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>
#include <limits>

namespace tureen {

namespace {

/// The range of everything within `radius` of a point that lies at `depth` along the viewing axis.
ClipRange range_of_sphere(double depth, double radius, DepthStorage storage) {
  // A soup with a single point also needs a range.
  radius = std::max(radius, 1e-6);
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

bool has_extent(const PlacedBounds& layer) { return layer.bounds.low != layer.bounds.high; }

/// A point of a layer relative to the eye, in world axes: far from the world's origin, the
/// translation minus the eye has digits that a world position lacks. For a layer that is only
/// translated, the products with 1 and 0 are exact.
glm::dvec3 seen_from(const glm::dvec3& eye, const glm::dmat4& world_from_layer,
                     const glm::dvec3& point) {
  return glm::dmat3(world_from_layer) * point + (glm::dvec3(world_from_layer[3]) - eye);
}

}  // namespace

ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, glm::dvec3 forward,
                     DepthStorage storage) {
  return range_of_sphere(glm::dot(bounds.centre() - eye, forward), bounds.radius(), storage);
}

ClipRange clip_range(std::span<const PlacedBounds> layers, const Camera& camera,
                     DepthStorage storage) {
  const glm::dvec3 eye = camera.eye(), forward = forward_of(camera);
  const auto count = std::count_if(layers.begin(), layers.end(), has_extent);
  if (count == 0 && layers.size() != 1) return range_of_sphere(0, 0, storage);

  if (count <= 1) {
    const PlacedBounds& only =
        count == 0 ? layers.front() : *std::find_if(layers.begin(), layers.end(), has_extent);
    const double scale = glm::length(glm::dvec3(only.world_from_layer[0]));
    const glm::dvec3 centre = seen_from(eye, only.world_from_layer, only.bounds.centre());
    return range_of_sphere(glm::dot(centre, forward), scale * only.bounds.radius(), storage);
  }

  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const PlacedBounds& layer : layers) {
    if (!has_extent(layer)) continue;
    const Bounds& box = layer.bounds;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 point(corner & 1 ? box.high.x : box.low.x,
                             corner & 2 ? box.high.y : box.low.y,
                             corner & 4 ? box.high.z : box.low.z);
      const glm::dvec3 seen = seen_from(eye, layer.world_from_layer, point);
      low = glm::min(low, seen);
      high = glm::max(high, seen);
    }
  }
  return range_of_sphere(glm::dot(0.5 * (low + high), forward), 0.5 * glm::length(high - low),
                         storage);
}

glm::dvec3 forward_of(const Camera& camera) { return -camera.world_from_view_rotation()[2]; }

std::optional<double> distance_of(double stored, const ClipRange& range, DepthStorage storage) {
  if (storage == DepthStorage::reversed_float)
    return stored > 0 ? std::optional(range.near / stored) : std::nullopt;
  if (stored >= 1) return std::nullopt;
  return range.near * range.far / (range.far - stored * (range.far - range.near));
}

}  // namespace tureen
