// The measurements of `tureen bench`: every set of views at every size; the cases alternate.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "jobs/bench/bench_cases.hpp"
#include "jobs/bench/bench_result.hpp"

namespace tureen {

struct MeasureOptions {
  int rounds = 5;
  double max_seconds = 0;                   // for all measurements; 0: no limit
  std::function<double()> clock = nullptr;  // as BenchmarkOptions::clock
  /// Called often with the fraction done, 0..1, and the current views; may throw to cancel.
  std::function<void(double fraction, const std::string& what)> progress = {};
  /// Called with the last timed frame of a measurement. Returns the name of its file, for
  /// BenchMeasurement::image.
  std::function<std::string(const BenchMeasurement&, const Image8&)> keep_frame = {};
};

/// Measures the views one after the other. The result lists the cases of each. Throws the errors of
/// the callbacks, and DeviceLimitError for a size beyond the device's limits.
std::vector<BenchMeasurement> measure(const BenchCases& cases, const std::vector<BenchViews>& views,
                                      const MeasureOptions& options);

}  // namespace tureen
