// What a series of frame times says: plain statistics, without clocks and without GL.
#pragma once

#include <cstddef>
#include <optional>
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

/// Frame times of one case: round by round, in each the same views in the same order.
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
  /// That all of this is said of.
  int rounds = 0;
  /// In them, one a view and round; the mean of its frames where it has several.
  std::size_t samples = 0;
};

/// Whether there are a hundred samples: a hundredth of them is one then, below which p99 lies and
/// of which low_1_percent_fps is the mean. Where a sample is several frames, both are of their
/// means, in which a single slow frame shows less.
bool tells_slowest_percent(const FrameStatistics& ms);

/// Asserts that there is a whole round.
FrameStatistics statistics_of(const FrameTimes& times);

/// The median over the rounds of each view.
std::vector<double> view_medians(const FrameTimes& times);

/// How far apart two series of the same thing lie that were measured in turns: relative to the
/// smaller, the larger of the difference of their min_of_medians and the median difference of their
/// rounds' medians. The second keeps one lucky pair from claiming that the machine is still.
/// Asserts that both have as many rounds.
double series_spread(const FrameTimes& first, const FrameTimes& second);

/// Of fewer rounds no spread is known. Two medians lie within a fifth of their standard deviation
/// one time in nine by mere chance, three of them one time in ninety (of normal ones), and what
/// lies so near would call any noise a difference.
inline constexpr int min_rounds = 3;

/// By how much two series may differ, as a fraction, though they time the same thing: the largest
/// of the A/A spread and of the spreads of their own rounds. Nothing where one of them has fewer
/// than least_rounds.
std::optional<double> spread_between(const FrameStatistics& a, const FrameStatistics& b,
                                     double aa_spread);

enum class Verdict { unknown, equal, faster, slower };

/// What the min_of_medians say of `a` against `b`, in all that `tureen bench` and the benchmarks
/// report: equal where they lie apart by less than twice spread_between() of the smaller; unknown
/// where that is.
Verdict verdict_on(const FrameStatistics& a, const FrameStatistics& b, double aa_spread);

}  // namespace tureen
