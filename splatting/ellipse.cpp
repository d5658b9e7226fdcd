#include "splatting/ellipse.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::splatting {

namespace {

float half_width_at(const Ellipse& ellipse, float dy) {
  const float r_dy = ellipse.r * dy;
  return std::sqrt(std::max(ellipse.limit - r_dy * r_dy, 0.0f)) / ellipse.p;
}

}  // namespace

void list_ellipse(const Ellipse& ellipse, std::uint32_t splat, TileLists& lists) {
  const auto& [x, y, p, q, r, limit, half_width, half_height] = ellipse;
  const auto [first, last] = lists.rows_between(y - half_height, y + half_height);
  if (last - first == 1) {
    lists.add(first, x - half_width, x + half_width, splat);
    return;
  }
  // The outline is dx = -slope dy +- sqrt(limit - (r dy)^2) / p. It is farthest to the right at
  // dy = -extreme, and farthest to the left at extreme.
  const float slope = q / p;
  const float extreme = half_height * q / std::hypot(q, r);
  for (int row = first; row < last; ++row) {
    const Band band = TileLists::band(row);
    const float low = std::max(band.low - y, -half_height);
    const float high = std::min(band.high - y, half_height);
    const float right_at = std::min(std::max(-extreme, low), high);
    const float left_at = std::min(std::max(extreme, low), high);
    lists.add(row, x - slope * left_at - half_width_at(ellipse, left_at),
              x - slope * right_at + half_width_at(ellipse, right_at), splat);
  }
}

}  // namespace tureen::splatting
