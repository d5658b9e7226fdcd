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
  double max_seconds = 0;                   // for all together; 0: no limit
  std::function<double()> clock = nullptr;  // of BenchmarkOptions
  /// Called often with the fraction done, 0..1, and what is being timed; may throw to end it.
  std::function<void(double fraction, const std::string& what)> progress = {};
  /// Called with the last frame timed for a measurement; returns the file that holds it, for
  /// BenchMeasurement::image.
  std::function<std::string(const BenchMeasurement&, const Image8&)> keep_frame = {};
};

/// One after the other, case by case within each. Throws what the callbacks
/// throw, DeviceLimitError for a size that the device does not draw and OutputError.
std::vector<BenchMeasurement> measure(const BenchCases& cases, const std::vector<BenchViews>& views,
                                      const MeasureOptions& options);

}  // namespace tureen
