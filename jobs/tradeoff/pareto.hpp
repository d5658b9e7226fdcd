// The Pareto front of time and error over measured configurations, and the choice. Plain
// arithmetic, without drawing.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tureen::tradeoff {

/// One measured configuration.
struct Point {
  double ms = 0;                 // a frame, > 0
  double spread_ms = 0;          // spread of repeated measurements; smaller differences are ties
  double psnr_db = 0;            // E_render, at most 100
  double coverage_mismatch = 0;  // fraction of pixels
  int departures = 0;            // settings off their defaults; breaks ties in favour of fewer
};

/// Errors within this difference are ties: a tenth of the smallest visible difference.
inline constexpr double psnr_tie_db = 0.1;

/// Indices of the points on the front, fastest first. Points of equal speed form a group. A point
/// joins if its time differs from that of the group's fastest point by at most the larger spread of
/// the two. Comparing with the fastest point prevents chains of ties. A group contributes a point
/// if its best PSNR exceeds the PSNR of the front's last point by more than `tie_db`. Among the
/// group's points within `tie_db` of its best, the point with the fewest departures is taken, then
/// the fastest, then the first. Times and PSNR therefore both increase along the front. For every
/// other point, a point on the front is as fast and as good, up to the ties.
std::vector<std::size_t> pareto_front(std::span<const Point> points, double tie_db = psnr_tie_db);

/// Error limits for an automatic choice.
struct Limits {
  /// At 50 dB a model with 27 dB against its photographs loses 0.02 dB (image/render_error.hpp).
  double min_psnr_db = 50;
  double max_coverage_mismatch = 1e-4;
};

/// The fastest point within the limits. Ties are broken by fewer departures, then PSNR, then order.
/// Returns nullopt if no point is within the limits.
std::optional<std::size_t> cheapest_within(std::span<const Point> points,
                                           const Limits& limits = {});

}  // namespace tureen::tradeoff
