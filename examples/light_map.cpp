#include "examples/light_map.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "examples/parallel.hpp"

namespace tureen::example {
namespace {

/// The longest line of constant v (`along` = 0) or constant u (1).
double longest_line(const Surface& surface, int along) {
  constexpr int lines = 8, steps = 32;  // sufficient for the low curvature of these shapes
  double longest = 0;
  for (int line = 0; line <= lines; ++line) {
    const auto at = [&](int step) {
      const double l = double(line) / lines, s = double(step) / steps;
      return surface.position(along == 0 ? glm::dvec2(s, l) : glm::dvec2(l, s));
    };
    double length = 0;
    for (int step = 0; step < steps; ++step) length += glm::distance(at(step), at(step + 1));
    longest = std::max(longest, length);
  }
  return longest;
}

}  // namespace

LightMap::LightMap(const Model& model, const Light& light, double spacing, int threads) {
  struct Row {
    std::uint32_t surface;
    int row;
  };
  std::vector<Row> rows;
  for (std::uint32_t s = 0; s < model.surfaces.size(); ++s) {
    const auto cells = [&](int along) {
      return std::max(1, int(std::ceil(longest_line(model.surfaces[s], along) / spacing)));
    };
    Grid grid{cells(0), cells(1), {}};
    grid.falling.resize(std::size_t(grid.columns + 1) * (grid.rows + 1));
    for (int row = 0; row <= grid.rows; ++row) rows.push_back({s, row});
    grids_.push_back(std::move(grid));
  }
  in_parallel(int(rows.size()), threads, [&](int i) {
    const auto [s, row] = rows[i];
    Grid& grid = grids_[s];
    for (int column = 0; column <= grid.columns; ++column) {
      const glm::dvec2 uv(double(column) / grid.columns, double(row) / grid.rows);
      grid.falling[std::size_t(row) * (grid.columns + 1) + column] =
          light.falling(s, model.point(s, uv));
    }
  });
}

glm::dvec3 LightMap::falling(std::uint32_t surface, glm::dvec2 uv) const {
  const Grid& grid = grids_[surface];
  const glm::dvec2 at = glm::clamp(uv, 0.0, 1.0) * glm::dvec2(grid.columns, grid.rows);
  const int column = std::min(int(at.x), grid.columns - 1),
            row = std::min(int(at.y), grid.rows - 1);
  const glm::dvec2 f = at - glm::dvec2(column, row);
  const auto corner = [&](int c, int r) {
    return glm::dvec3(grid.falling[std::size_t(row + r) * (grid.columns + 1) + column + c]);
  };
  return glm::mix(glm::mix(corner(0, 0), corner(1, 0), f.x),
                  glm::mix(corner(0, 1), corner(1, 1), f.x), f.y);
}

}  // namespace tureen::example
