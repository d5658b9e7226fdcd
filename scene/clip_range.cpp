#include "scene/clip_range.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
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

bool has_extent(const LayerPlace& layer) { return layer.bounds.low != layer.bounds.high; }

struct Sphere {
  double depth;  // of the centre, along the viewing axis
  double radius;
};

/// The sphere around a layer. Its centre is computed relative to the eye: far from the world's
/// origin, the translation minus the eye has digits that a world position lacks. For a layer that
/// is only translated, the products with 1 and 0 are exact.
Sphere sphere_of(const LayerPlace& layer, const Camera& camera) {
  const glm::dmat4& place = layer.world_from_layer;
  const glm::dvec3 center =
      glm::dmat3(place) * layer.bounds.center() + (glm::dvec3(place[3]) - camera.eye());
  const double scale = glm::length(glm::dvec3(place[0]));
  return {glm::dot(center, forward_of(camera)), scale * layer.bounds.radius()};
}

}  // namespace

ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, glm::dvec3 forward,
                     DepthStorage storage) {
  return range_of_sphere(glm::dot(bounds.center() - eye, forward), bounds.radius(), storage);
}

ClipRange clip_range(std::span<const LayerPlace> layers, const Camera& camera,
                     DepthStorage storage) {
  ClipRange all{std::numeric_limits<double>::infinity(), 0};
  for (const LayerPlace& layer : layers) {
    const Sphere sphere = sphere_of(layer, camera);
    const ClipRange one = range_of_sphere(sphere.depth, sphere.radius, storage);
    if (layers.size() == 1) return one;
    if (!has_extent(layer) || sphere.depth + sphere.radius < 0) continue;
    all = {std::min(all.near, one.near), std::max(all.far, one.far)};
  }
  return all.far > 0 ? all : range_of_sphere(0, 0, storage);
}

glm::dvec3 forward_of(const Camera& camera) { return -camera.world_from_view_rotation()[2]; }

std::optional<double> distance_of(double stored, const ClipRange& range, DepthStorage storage) {
  if (storage == DepthStorage::reversed_float)
    return stored > 0 ? std::optional(range.near / stored) : std::nullopt;
  if (stored >= 1) return std::nullopt;
  return range.near * range.far / (range.far - stored * (range.far - range.near));
}

}  // namespace tureen
