// Painted parametric surfaces, and the unconnected triangles that stand for them. The texels of a
// triangle are computed on the true surface, so the facets look round.
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
  double gloss = 0;        // [0, 1]: becomes the residual weight of the color MLP
  double alpha = 1;        // below alpha_threshold there is a hole
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
  double texel_size = 0.1;  // how fine the paint is: decides each face's level
  /// Where there is nothing fine to see (hidden, unpainted): two levels less. None by default.
  std::function<bool(const SurfacePoint&)> plain = {};
  double translucency = 0;  // how much of the light on the back shows, [0, 1]
};

struct Face {
  std::uint32_t surface = 0;
  int level = 1;
  std::array<glm::dvec2, 3> uv;
  std::array<glm::dvec3, 3> corners;
};

/// A face's level lies in this range: the smallest that reaches its surface's texel_size, or
/// two less where the surface is plain.
inline constexpr int min_level = 1, max_level = 4;

struct Model {
  std::vector<Surface> surfaces;
  std::vector<Face> faces;

  /// Two faces a cell of the grid, less those that vanish at a pole or are cut away altogether.
  void add(Surface surface);

  SurfacePoint point(std::uint32_t surface, glm::dvec2 uv) const;
  Paint paint(const SurfacePoint& at, std::uint32_t surface) const {
    return surfaces[surface].paint(at);
  }
  /// The parameters of the texel (x, y) of a face's lattice.
  glm::dvec2 texel_uv(const Face& face, int x, int y) const;
};

}  // namespace tureen::example
