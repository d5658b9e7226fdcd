// What a series of frame times says: plain statistics, without clocks and without GL.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tureen {

/// The middle value; of an even number the mean of the two in the middle. Asserts that there is
/// one.
double median(std::span<const double> values);

double mean(std::span<const double> values);

/// The exponential of the mean of the logarithms: what ratios are averaged by, as it is the same
/// whichever of two things is divided by the other. All values > 0; asserts that there is one.
double geometric_mean(std::span<const double> values);

/// The smallest of the values that `percent` of all are not above (nearest rank). 0 < percent <=
/// 100.
double percentile(std::span<const double> values, double percent);

/// Frame times of one entrant: round by round, in each the same views in the same order.
struct FrameTimes {
  std::size_t views = 0;
  std::vector<double> ms;  // a multiple of `views`, at least one round

  std::size_t rounds() const { return views ? ms.size() / views : 0; }
  std::span<const double> round(std::size_t index) const {
    return std::span(ms).subspan(index * views, views);
  }
};

/// Milliseconds where nothing else is said.
struct FrameStatistics {
  double mean = 0;
  double median = 0;  // which is the 50th percentile but for its two middle values
  double p95 = 0;
  double p99 = 0;
  /// The smallest of the rounds' medians: what the machine does when nothing disturbs it. Ratios
  /// are taken of these.
  double min_of_medians = 0;
  /// How far the rounds' medians lie apart: (third quartile - smallest) / smallest. The quartile,
  /// because one disturbed round says little about the others.
  double spread = 0;
  /// Frames a second at the pace of the slowest one in a hundred (at least one).
  double low_1_percent_fps = 0;
};

/// Asserts that there is a whole round.
FrameStatistics statistics_of(const FrameTimes& times);

/// The median over the rounds of each view.
std::vector<double> view_medians(const FrameTimes& times);

/// How far apart two series of the same thing lie that were measured in turns: relative to the
/// smaller, the larger of the difference of their min_of_medians and the median difference of their
/// rounds' medians. The second keeps one lucky pair from claiming that the machine is still.
/// Asserts that both have as many rounds.
double series_spread(const FrameTimes& first, const FrameTimes& second);

/// Whether the difference of two min_of_medians is one that the spread does not explain:
/// |a - b| >= 2 spread of the smaller.
bool differ(double a, double b, double spread);

}  // namespace tureen
