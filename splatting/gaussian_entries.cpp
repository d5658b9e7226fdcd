#include "splatting/gaussian_entries.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::splatting {

void read_entry(const ParameterRows& projected, std::size_t i, GaussianEntry& entry,
                GaussianOutline& outline) {
  namespace row = projected_gaussian_row;
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  entry = {value(row::x),    value(row::y),           value(row::p),   value(row::q),
           value(row::r),    value(row::log_opacity), value(row::red), value(row::green),
           value(row::blue), 1.0f / value(row::depth)};
  outline = {value(row::half_width), value(row::half_height)};
}

void list_gaussian(const GaussianEntry& entry, const GaussianOutline& outline, float min_log_alpha,
                   std::uint32_t splat, TileLists& lists) {
  const auto [half_width, half_height] = outline;
  const auto [first, last] = lists.rows_between(entry.y - half_height, entry.y + half_height);
  if (last - first == 1) {
    lists.add(first, entry.x - half_width, entry.x + half_width, splat);
    return;
  }
  // The outline is dx = -slope dy +- sqrt(excess - (r dy)^2) / p. It is farthest to the right at
  // dy = -extreme, and farthest to the left at extreme.
  const float excess = entry.log_opacity - min_log_alpha;
  const float slope = entry.q / entry.p;
  const float extreme = half_height * entry.q / std::hypot(entry.q, entry.r);
  const auto half_width_at = [&](float dy) {
    return std::sqrt(std::max(excess - entry.r * entry.r * dy * dy, 0.0f)) / entry.p;
  };
  for (int row = first; row < last; ++row) {
    const Band band = TileLists::band(row);
    const float low = std::max(band.low - entry.y, -half_height);
    const float high = std::min(band.high - entry.y, half_height);
    const float right_at = std::min(std::max(-extreme, low), high);
    const float left_at = std::min(std::max(extreme, low), high);
    lists.add(row, entry.x - slope * left_at - half_width_at(left_at),
              entry.x - slope * right_at + half_width_at(right_at), splat);
  }
}

}  // namespace tureen::splatting
