#include "jobs/timing/frame_statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tureen {

namespace {

std::vector<double> sorted(std::span<const double> values) {
  std::vector<double> result(values.begin(), values.end());
  std::sort(result.begin(), result.end());
  return result;
}

/// Index of the nearest rank among `count` sorted values.
std::size_t rank(std::size_t count, double percent) {
  // 95 % of 20 is 19.000000000000004 in doubles; it must not round up to the 20th.
  constexpr double rounding = 1e-9;
  const double exact = std::ceil(double(count) * percent / 100 - rounding);
  return std::clamp<std::size_t>(std::size_t(std::max(exact, 1.0)), 1, count) - 1;
}

std::vector<double> round_medians(const FrameTimes& times) {
  std::vector<double> medians;
  for (std::size_t i = 0; i < times.rounds(); ++i) medians.push_back(median(times.round(i)));
  return medians;
}

double relative_difference(double a, double b) { return std::abs(a - b) / std::min(a, b); }

}  // namespace

double median(std::span<const double> values) {
  assert(!values.empty());
  const std::vector<double> ordered = sorted(values);
  const std::size_t half = ordered.size() / 2;
  return ordered.size() % 2 ? ordered[half] : 0.5 * (ordered[half - 1] + ordered[half]);
}

double mean(std::span<const double> values) {
  assert(!values.empty());
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double percentile(std::span<const double> values, double percent) {
  assert(!values.empty() && percent > 0 && percent <= 100);
  return sorted(values)[rank(values.size(), percent)];
}

FrameStatistics statistics_of(const FrameTimes& times) {
  assert(times.rounds() > 0 && times.ms.size() % times.views == 0);
  const std::vector<double> medians = sorted(round_medians(times));
  const std::vector<double> ordered = sorted(times.ms);
  const std::size_t slow = std::max<std::size_t>(ordered.size() / 100, 1);
  FrameStatistics result;
  result.mean = mean(times.ms);
  result.median = median(times.ms);
  result.p95 = ordered[rank(ordered.size(), 95)];
  result.p99 = ordered[rank(ordered.size(), 99)];
  result.min_of_medians = medians.front();
  result.spread = relative_difference(percentile(medians, 75), medians.front());
  result.low_1_percent_fps = 1000 / mean(std::span(ordered).last(slow));
  result.rounds = int(times.rounds());
  result.samples = times.ms.size();
  return result;
}

// With 100 samples, the nearest rank for p99 is the 99th, so one slower sample remains.
bool tells_slowest_percent(const FrameStatistics& ms) { return ms.samples >= 100; }

std::vector<double> view_medians(const FrameTimes& times) {
  std::vector<double> result;
  for (std::size_t view = 0; view < times.views; ++view) {
    std::vector<double> of_view;
    for (std::size_t i = 0; i < times.rounds(); ++i) of_view.push_back(times.round(i)[view]);
    result.push_back(median(of_view));
  }
  return result;
}

double series_spread(const FrameTimes& first, const FrameTimes& second) {
  assert(first.rounds() == second.rounds() && first.rounds() > 0);
  const std::vector<double> a = round_medians(first), b = round_medians(second);
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(relative_difference(a[i], b[i]));
  const double of_smallest = relative_difference(*std::min_element(a.begin(), a.end()),
                                                 *std::min_element(b.begin(), b.end()));
  return std::max(of_smallest, median(differences));
}

std::optional<double> spread_between(const FrameStatistics& a, const FrameStatistics& b,
                                     double aa_spread) {
  if (std::min(a.rounds, b.rounds) < min_rounds) return {};
  return std::max({aa_spread, a.spread, b.spread});
}

Verdict verdict_on(const FrameStatistics& a, const FrameStatistics& b, double aa_spread) {
  const std::optional<double> spread = spread_between(a, b, aa_spread);
  if (!spread) return Verdict::unknown;
  const double ours = a.min_of_medians, theirs = b.min_of_medians;
  if (ours == theirs || relative_difference(ours, theirs) < 2 * *spread) return Verdict::equal;
  return ours < theirs ? Verdict::faster : Verdict::slower;
}

const char* name_of(Verdict verdict) {
  constexpr const char* names[] = {"unknown", "equal", "faster", "slower"};
  return names[std::size_t(verdict)];
}

}  // namespace tureen
