// Painted parametric surfaces, and triangles for ray casting. Shading uses the true surface at the
// hit, so facets look round.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace tureen::example {

/// The material of a surface at one point.
struct Paint {
  glm::dvec3 albedo{0.5};  // linear
  double gloss = 0;        // [0, 1]: strength of the Fresnel mirror, see glazed()
  bool hole = false;       // only on surfaces with cut_out
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
  bool closed = false;      // whether u = 1 is u = 0
  bool cut_out = false;     // whether the paint has holes; rays evaluate it
  double translucency = 0;  // weight of the light from the back, [0, 1]
};

struct Face {
  std::uint32_t surface = 0;
  std::array<glm::dvec2, 3> uv;
  std::array<glm::dvec3, 3> corners;
};

struct Model {
  std::vector<Surface> surfaces;
  std::vector<Face> faces;

  /// Adds two faces per cell of the grid, without those that vanish at a pole.
  void add(Surface surface);

  SurfacePoint point(std::uint32_t surface, glm::dvec2 uv) const;
  Paint paint(const SurfacePoint& at, std::uint32_t surface) const {
    return surfaces[surface].paint(at);
  }
};

}  // namespace tureen::example
