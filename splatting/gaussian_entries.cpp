#include "splatting/gaussian_entries.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::splatting {

void list_gaussian(const GaussianEntry& entry, float min_log_alpha, std::uint32_t splat,
                   TileLists& lists) {
  const float half_width = entry.half_width, half_height = entry.half_height;
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
