#include "splatting/window_entries.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tureen::splatting {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// The x coordinates of the part of a triangle in a band. Empty: low > high.
Band columns_in(const WindowOutline& corners, const Band& band) {
  Band result{infinite, -infinite};
  const auto add = [&](float x) {
    result.low = std::min(result.low, x);
    result.high = std::max(result.high, x);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const float ax = corners[2 * k], ay = corners[2 * k + 1];
    const float bx = corners[2 * next], by = corners[2 * next + 1];
    if (ay >= band.low && ay <= band.high) add(ax);
    for (const float y : {band.low, band.high})
      if ((ay < y) != (by < y)) add(ax + (bx - ax) * ((y - ay) / (by - ay)));
  }
  return result;
}

}  // namespace

void read_entry(const ParameterRows& projected, std::size_t i, WindowEntry& entry,
                WindowOutline& outline) {
  namespace row = projected_window_row;
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  entry.x = value(row::x);
  entry.y = value(row::y);
  for (std::size_t k = 0; k < 9; ++k) entry.edges[k] = value(row::edges + k);
  for (std::size_t k = 0; k < 3; ++k) entry.inverse_depth[k] = value(row::inverse_depth + k);
  entry.sigma = value(row::sigma);
  entry.log_opacity = value(row::log_opacity);
  entry.min_rho = value(row::min_rho);
  entry.red = value(row::red);
  entry.green = value(row::green);
  entry.blue = value(row::blue);
  for (std::size_t k = 0; k < 6; ++k) outline[k] = value(row::outline + k);
  entry.reaches_near = std::isnan(outline[0]);
}

void list_window(const WindowOutline& outline, std::uint32_t splat, TileLists& lists) {
  if (std::isnan(outline[0])) {  // may cover any pixel
    for (int row = 0; row < lists.rows(); ++row) lists.add(row, 0, infinite, splat);
    return;
  }
  const auto [low, high] = std::minmax({outline[1], outline[3], outline[5]});
  const auto [first, last] = lists.rows_between(low, high);
  for (int row = first; row < last; ++row) {
    const Band columns = columns_in(outline, TileLists::band(row));
    if (columns.low <= columns.high) lists.add(row, columns.low, columns.high, splat);
  }
}

}  // namespace tureen::splatting
