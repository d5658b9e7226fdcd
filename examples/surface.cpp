#include "examples/surface.hpp"

#include <glm/geometric.hpp>

namespace tureen::example {

void Model::add(Surface added) {
  const auto index = static_cast<std::uint32_t>(surfaces.size());
  surfaces.push_back(std::move(added));
  const Surface& surface = surfaces.back();
  const auto uv = [&](int column, int row) {
    return glm::dvec2(double(column) / surface.columns, double(row) / surface.rows);
  };
  const auto corner = [&](int column, int row) {
    // Both sides of the seam must have bit-identical vertices; otherwise rays pass between them.
    if (surface.closed) column %= surface.columns;
    return surface.position(uv(column, row));
  };
  const auto add_face = [&](std::array<glm::ivec2, 3> at) {
    Face face{.surface = index, .uv = {}, .corners = {}};
    for (int i = 0; i < 3; ++i) {
      face.uv[i] = uv(at[i].x, at[i].y);
      face.corners[i] = corner(at[i].x, at[i].y);
    }
    const double area = glm::length(
        glm::cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]));
    if (area < 1e-9) return;  // at a pole; the smallest real face of the scene has 1e-5
    faces.push_back(face);
  };
  for (int row = 0; row < surface.rows; ++row)
    for (int column = 0; column < surface.columns; ++column) {
      const glm::ivec2 a(column, row), b(column + 1, row), c(column + 1, row + 1),
          d(column, row + 1);
      // Diagonals alternate, so that no direction is favoured.
      if ((row + column) % 2 == 0) {
        add_face({a, b, c});
        add_face({a, c, d});
      } else {
        add_face({a, b, d});
        add_face({b, c, d});
      }
    }
}

SurfacePoint Model::point(std::uint32_t index, glm::dvec2 uv) const {
  const Surface& surface = surfaces[index];
  constexpr double h = 1e-4;
  // At a pole d/du vanishes, so the normal is taken nearby. The difference is not visible.
  const glm::dvec2 inner = glm::clamp(uv, glm::dvec2(2 * h), glm::dvec2(1 - 2 * h));
  const glm::dvec2 near(surface.closed ? uv.x : inner.x, inner.y);
  const glm::dvec3 du =
      surface.position(near + glm::dvec2(h, 0)) - surface.position(near - glm::dvec2(h, 0));
  const glm::dvec3 dv =
      surface.position(near + glm::dvec2(0, h)) - surface.position(near - glm::dvec2(0, h));
  return {uv, surface.position(uv), glm::normalize(glm::cross(du, dv))};
}

}  // namespace tureen::example
