#include "splatting/neural/neural_entries.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::splatting {

void read_density(const ParameterRows& projected, std::size_t i, NeuralEntry& entry,
                  Ellipse& outline) {
  namespace row = projected_neural_row;
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  const auto read = [&](std::size_t first, auto& values) {
    for (std::size_t k = 0; k < std::size(values); ++k) values[k] = value(first + k);
  };
  read(row::center, entry.center);
  read(row::sphere_from_view, entry.sphere_from_view);
  entry.by_unit = value(row::by_unit);
  entry.near = value(row::near);
  entry.twice_by_largest = value(row::twice_by_largest);
  read(row::frequencies, entry.frequencies);
  read(row::phases, entry.phases);
  read(row::amplitudes, entry.amplitudes);
  entry.offset = value(row::offset);
  entry.red = value(row::red);
  entry.green = value(row::green);
  entry.blue = value(row::blue);
  float of_outline[7];
  read(row::outline, of_outline);
  const auto& [x, y, p, q, r, half_width, half_height] = of_outline;
  outline = {.x = x,
             .y = y,
             .p = p,
             .q = q,
             .r = r,
             .limit = 1,
             .half_width = half_width,
             .half_height = half_height};
}

void list_density(const Ellipse& outline, std::uint32_t splat, TileLists& lists) {
  if (std::isnan(outline.x))
    lists.add_everywhere(splat);
  else
    list_ellipse(outline, splat, lists);
}

}  // namespace tureen::splatting
