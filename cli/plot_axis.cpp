#include "cli/plot_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tureen::cli {

namespace {

/// The smallest of 1, 2, 5 times a power of ten that is at least `wanted`.
double round_step(double wanted) {
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double factor : {1.0, 2.0, 5.0})
    // A step that is short by rounding alone counts.
    if (factor * power >= wanted * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::string label(double value) {
  if (std::abs(value) >= 10'000) return fmt::format("{:g}k", value / 1000);
  return fmt::format("{:g}", value);
}

/// Multiples of `step` within [low, high], in units of `unit`.
std::vector<Tick> multiples(double low, double high, double step, double unit) {
  std::vector<Tick> ticks;
  // The ends belong to it even where a division rounds.
  const double slack = 1e-9;
  for (double i = std::ceil(low / step - slack); i * step <= high + slack * step; ++i)
    // Adding 0 turns -0 into 0.
    ticks.push_back({i * step * unit, label(i * step + 0.0)});
  return ticks;
}

}  // namespace

PlotAxis PlotAxis::linear(double low, double high, int most_ticks) {
  PlotAxis axis;
  if (!(high > low)) {
    const double around = std::max(std::abs(low), 1.0) / 2;
    low -= around;
    high += around;
  }
  axis.low_ = low;
  axis.high_ = high;
  axis.ticks_ = multiples(low, high, round_step((high - low) / most_ticks), 1);
  return axis;
}

PlotAxis PlotAxis::duration(double high, int most_ticks) {
  PlotAxis axis;
  axis.high_ = high > 0 ? high : 1;
  double unit = 1;
  axis.unit_ = "seconds";
  if (axis.high_ > 3 * 3600) {
    unit = 3600;
    axis.unit_ = "hours";
  } else if (axis.high_ > 180) {
    unit = 60;
    axis.unit_ = "minutes";
  }
  const double end = axis.high_ / unit;
  axis.ticks_ = multiples(0, end, round_step(end / most_ticks), unit);
  return axis;
}

PlotAxis PlotAxis::logarithmic(double low, double high, int most_ticks) {
  PlotAxis axis;
  axis.logarithmic_ = true;
  if (!(high > low)) {
    low /= 2;
    high *= 2;
  }
  axis.low_ = low;
  axis.high_ = high;
  const int first = int(std::floor(std::log10(low))), last = int(std::ceil(std::log10(high)));
  const std::vector<std::vector<double>> finer_first{
      {1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 5, 7}, {1, 2, 5}, {1}};
  for (const std::vector<double>& factors : finer_first) {
    axis.ticks_.clear();
    for (int power = first; power <= last; ++power)
      for (const double factor : factors) {
        const double value = factor * std::pow(10.0, power);
        if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9))
          axis.ticks_.push_back({value, label(value)});
      }
    if (int(axis.ticks_.size()) <= most_ticks) break;
  }
  return axis;
}

double PlotAxis::position(double value) const {
  if (!logarithmic_) return (value - low_) / (high_ - low_);
  return std::log(value / low_) / std::log(high_ / low_);
}

}  // namespace tureen::cli
