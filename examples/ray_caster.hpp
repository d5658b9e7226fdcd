// Finds the nearest face on a ray with a hierarchy of boxes. Rays pass through holes.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "examples/surface.hpp"

namespace tureen::example {

struct Hit {
  std::uint32_t face;
  glm::dvec2 uv;  // of the face's surface
};

class RayCaster {
 public:
  /// The model must outlive this.
  explicit RayCaster(const Model& model);

  /// Ignores hits nearer than `nearest`. Safe to call from several threads.
  std::optional<Hit> first_hit(glm::dvec3 origin, glm::dvec3 direction, double nearest) const;

 private:
  struct Node {
    glm::dvec3 low, high;
    std::uint32_t first = 0;  // index into faces_ for a leaf, else of the first child
    std::uint32_t count = 0;  // number of faces; 0 for an inner node
  };
  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

  const Model& model_;
  std::vector<std::uint32_t> faces_;
  std::vector<Node> nodes_;
};

}  // namespace tureen::example
