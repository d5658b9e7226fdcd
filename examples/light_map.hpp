// Diffuse light on a grid over every surface. It does not depend on the viewpoint, so it is
// computed once for all photographs.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "examples/light.hpp"
#include "examples/surface.hpp"

namespace tureen::example {

class LightMap {
 public:
  /// The grid's points are at most `spacing` apart. The result does not depend on `threads`.
  LightMap(const Model& model, const Light& light, double spacing, int threads);

  /// Light::falling, interpolated.
  glm::dvec3 falling(std::uint32_t surface, glm::dvec2 uv) const;

 private:
  struct Grid {
    int columns, rows;               // cells
    std::vector<glm::vec3> falling;  // (columns + 1) * (rows + 1), row by row; u runs along a row
  };
  std::vector<Grid> grids_;  // one a surface
};

}  // namespace tureen::example
