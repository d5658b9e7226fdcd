#include "jobs/tradeoff/pareto.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tureen::tradeoff {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Fastest first; for equal times, the higher PSNR first.
std::vector<std::size_t> by_time(std::span<const Point> points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (points[a].ms != points[b].ms) return points[a].ms < points[b].ms;
    if (points[a].psnr_db != points[b].psnr_db) return points[a].psnr_db > points[b].psnr_db;
    return a < b;
  });
  return order;
}

bool equally_fast(const Point& first, const Point& other) {
  return other.ms - first.ms <= std::max(first.spread_ms, other.spread_ms);
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const Point> points, double tie_db) {
  const std::vector<std::size_t> order = by_time(points);
  std::vector<std::size_t> front;
  double reached = -infinity;
  for (std::size_t begin = 0, end; begin < order.size(); begin = end) {
    double best = -infinity;
    for (end = begin; end < order.size() && equally_fast(points[order[begin]], points[order[end]]);
         ++end)
      best = std::max(best, points[order[end]].psnr_db);
    if (!(best > reached + tie_db)) continue;
    std::optional<std::size_t> taken;
    for (std::size_t i = begin; i < end; ++i) {
      const Point& point = points[order[i]];
      if (point.psnr_db < best - tie_db || !(point.psnr_db > reached + tie_db)) continue;
      if (!taken || point.departures < points[*taken].departures) taken = order[i];
    }
    front.push_back(*taken);
    reached = points[*taken].psnr_db;
  }
  return front;
}

std::optional<std::size_t> cheapest_within(std::span<const Point> points, const Limits& limits) {
  std::optional<std::size_t> fastest, taken;
  for (const std::size_t i : by_time(points)) {
    const Point& point = points[i];
    if (!(point.psnr_db >= limits.min_psnr_db) ||
        !(point.coverage_mismatch <= limits.max_coverage_mismatch))
      continue;
    if (!fastest) fastest = i;
    if (!equally_fast(points[*fastest], point)) continue;
    const auto simpler = [](const Point& a, const Point& b) {
      return a.departures != b.departures ? a.departures < b.departures : a.psnr_db > b.psnr_db;
    };
    if (!taken || simpler(point, points[*taken])) taken = i;
  }
  return taken;
}

}  // namespace tureen::tradeoff
