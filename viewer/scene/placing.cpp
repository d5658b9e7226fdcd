#include "viewer/scene/placing.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tureen::viewer {

glm::dmat4 on_the_ground(const DocumentLayer& layer, const glm::dvec3& up) {
  const Bounds& box = layer.bounds;
  double lowest = std::numeric_limits<double>::infinity();
  const auto add = [&](const glm::dvec3& point) {
    if (glm::clamp(glm::vec3(point), box.low, box.high) != glm::vec3(point)) return;
    lowest =
        std::min(lowest, glm::dot(up, glm::dvec3(layer.world_from_layer * glm::dvec4(point, 1))));
  };
  if (const TriangleSoup* const soup = soup_of(layer)) {
    for (const glm::uvec3& corners : soup->triangles)
      for (int k = 0; k < 3; ++k) add(soup->positions[corners[k]]);
  } else {
    const Splats& splats = *splats_of(layer);
    for (std::size_t i = 0; i < count(splats); ++i) add(center(splats, i));
  }
  if (lowest == std::numeric_limits<double>::infinity()) return layer.world_from_layer;
  return at_origin(-lowest * up) * layer.world_from_layer;
}

glm::dmat4 in_the_middle(const DocumentLayer& layer) {
  const glm::dvec3 middle(layer.world_from_layer * glm::dvec4(layer.bounds.center(), 1));
  return at_origin(-middle) * layer.world_from_layer;
}

}  // namespace tureen::viewer
