// Which of many measured ways to draw are worth having: the Pareto front of time and error, one
// number for it, and the choice. Plain arithmetic; nothing here draws.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tureen::tradeoff {

/// One way to draw, measured.
struct Point {
  double ms = 0;         // a frame, > 0
  double spread_ms = 0;  // of repeated measurements: what lies closer than this is equally fast
  double psnr_db = 0;    // E_render, at most 100
  double coverage_mismatch = 0;  // fraction of pixels
  int departures = 0;            // from the defaults: of equals the one with fewer is the simpler
};

/// Errors that differ by no more are the same: a tenth of what anybody has ever seen.
inline constexpr double psnr_tie_db = 0.1;

/// Indices of the points that are worth having, fastest first. Points are taken in groups that are
/// equally fast (within the spread of either, counted from the fastest of the group, so that no
/// chain of ties drifts). A group counts if something in it is better than all that is faster, by
/// more than `tie_db`; of its best, within `tie_db`, the simplest is taken, then the fastest, then
/// the first. So times and decibels both rise along the front, and every point left out has one on
/// the front that is as fast and as good, up to the ties.
std::vector<std::size_t> pareto_front(std::span<const Point> points, double tie_db = psnr_tie_db);

/// The corner that nobody wants to be behind: 100 ms and 20 dB.
struct Corner {
  double ms = 100;
  double psnr_db = 20;
};

/// The area between the corner and the points, where the horizontal axis is the logarithm of time
/// as it is plotted: decades times decibels. Grows when anything gets faster or better; 0 where
/// every point is slower or worse than the corner. Exact, ties play no part.
double hypervolume(std::span<const Point> points, const Corner& corner = {});

/// What a way to draw must keep to be taken without asking.
struct Limits {
  /// Costs a model that comes within 27 dB of its photographs 0.02 dB (image/render_error.hpp).
  double min_psnr_db = 50;
  double max_coverage_mismatch = 1e-4;
};

/// The fastest point within the limits; of those equally fast the simplest, then the better, then
/// the first. None where no point is within them.
std::optional<std::size_t> cheapest_within(std::span<const Point> points,
                                           const Limits& limits = {});

}  // namespace tureen::tradeoff
