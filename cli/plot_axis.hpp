// Axes of plots: where values lie along one, and round numbers to label it with.
#pragma once

#include <string>
#include <vector>

namespace tureen::cli {

struct Tick {
  double value;
  std::string label;
};

class PlotAxis {
 public:
  /// From `low` to `high`, or a little around them where they are equal; finite. At most about
  /// `most_ticks` ticks at multiples of 1, 2 or 5 times a power of ten; thousands are "10k".
  static PlotAxis linear(double low, double high, int most_ticks);

  /// Durations in seconds from 0 to `high`: ticks in seconds, minutes or hours, whichever leaves
  /// numbers of two digits or so; unit() says which.
  static PlotAxis duration(double high, int most_ticks);

  /// Logarithmic, low > 0; ticks at 1, 2 and 5 times powers of ten, or at powers alone over many
  /// decades.
  static PlotAxis logarithmic(double low, double high, int most_ticks);

  /// 0 at the low end, 1 at the high one, outside of that beyond. NaN for what a logarithm lacks.
  double position(double value) const;

  const std::vector<Tick>& ticks() const { return ticks_; }
  const std::string& unit() const { return unit_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 0, high_ = 1;
  bool logarithmic_ = false;
  std::string unit_;
  std::vector<Tick> ticks_;
};

}  // namespace tureen::cli
