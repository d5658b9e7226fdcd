// Statistics of a series of frame times, without clocks and without GL.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tureen {

/// The median; for an even number of values the mean of the middle two. Asserts at least one value.
double median(std::span<const double> values);

double mean(std::span<const double> values);

/// The nearest-rank percentile: the smallest value v such that at least `percent` % of all values
/// are at most v. 0 < percent <= 100.
double percentile(std::span<const double> values, double percent);

/// Frame times of one case, round by round; each round has the same views in the same order.
struct FrameTimes {
  std::size_t views = 0;
  std::vector<double> ms;  // a multiple of `views`, at least one round

  std::size_t rounds() const { return views ? ms.size() / views : 0; }
  std::span<const double> round(std::size_t index) const {
    return std::span(ms).subspan(index * views, views);
  }
};

/// In milliseconds unless stated otherwise.
struct FrameStatistics {
  double mean = 0;
  double median = 0;  // the 50th percentile, averaging the middle two
  double p95 = 0;
  double p99 = 0;
  /// The smallest of the rounds' medians: the speed of the undisturbed machine. Ratios use it.
  double min_of_medians = 0;
  /// Variation of the rounds' medians, a fraction: (third quartile - smallest) / smallest. The
  /// quartile is robust against one disturbed round.
  double spread = 0;
  /// Frame rate of the slowest 1 % of the frames (at least one).
  double low_1_percent_fps = 0;
  /// Number of rounds in the statistics.
  int rounds = 0;
  /// Number of samples, one a view and round; a sample of several frames counts as their mean.
  std::size_t samples = 0;
};

/// Whether there are at least 100 samples, so that the slowest 1 % has at least one sample. If
/// samples have several frames, p99 and low_1_percent_fps use means, which hide single slow frames.
bool tells_slowest_percent(const FrameStatistics& ms);

/// Asserts a whole round.
FrameStatistics statistics_of(const FrameTimes& times);

/// The median of each view over the rounds.
std::vector<double> view_medians(const FrameTimes& times);

/// The relative difference of two alternating series of the same case: the larger of two values.
/// One is the difference of their min_of_medians, relative to the smaller. The other is the median
/// difference of their rounds' medians; it prevents one lucky pair from hiding the noise. Asserts
/// an equal number of rounds.
double series_spread(const FrameTimes& first, const FrameTimes& second);

/// Smallest number of rounds for a spread. Two normally distributed medians lie within a fifth of
/// their standard deviation one time in nine by chance, three medians one time in ninety. So small
/// a spread would make noise look significant.
inline constexpr int min_rounds = 3;

/// The difference, as a fraction, at which two series may still be equal: the largest of the A/A
/// spread and their own spreads. Returns nullopt if either has fewer than min_rounds rounds.
std::optional<double> spread_between(const FrameStatistics& a, const FrameStatistics& b,
                                     double aa_spread);

enum class Verdict { unknown, equal, faster, slower };

/// "unknown", "equal", "faster", "slower".
const char* name_of(Verdict verdict);

/// Compares the min_of_medians of `a` and `b`; `tureen bench` and the benchmarks use it. Equal:
/// they differ by less than twice spread_between(), relative to the smaller. Unknown:
/// spread_between() is unknown.
Verdict verdict_on(const FrameStatistics& a, const FrameStatistics& b, double aa_spread);

}  // namespace tureen
