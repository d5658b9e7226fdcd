// Painted parametric surfaces, and the triangles that rays meet in their place. What a ray then
// sees is computed on the true surface, so the facets look round.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace tureen::example {

/// What a surface is made of at one point.
struct Paint {
  glm::dvec3 albedo{0.5};  // linear
  double gloss = 0;        // [0, 1]: how much of Fresnel's mirror shows, see glazed()
  bool hole = false;       // only where the surface says that it is cut_out
};

struct SurfacePoint {
  glm::dvec2 uv;
  glm::dvec3 position;
  glm::dvec3 normal;  // unit length, outward: along d/du x d/dv
};

struct Surface {
  std::function<glm::dvec3(glm::dvec2 uv)> position;  // uv in [0, 1]^2
  std::function<Paint(const SurfacePoint&)> paint;
  int columns = 1;          // along u
  int rows = 1;             // along v
  bool closed = false;      // u = 1 is u = 0
  bool cut_out = false;     // the paint has holes: rays ask it
  double translucency = 0;  // how much of the light on the back shows, [0, 1]
};

struct Face {
  std::uint32_t surface = 0;
  std::array<glm::dvec2, 3> uv;
  std::array<glm::dvec3, 3> corners;
};

struct Model {
  std::vector<Surface> surfaces;
  std::vector<Face> faces;

  /// Two faces a cell of the grid, less those that vanish at a pole.
  void add(Surface surface);

  SurfacePoint point(std::uint32_t surface, glm::dvec2 uv) const;
  Paint paint(const SurfacePoint& at, std::uint32_t surface) const {
    return surfaces[surface].paint(at);
  }
};

}  // namespace tureen::example
