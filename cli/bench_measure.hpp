// The measurements of `tureen bench`: every set of views at every size, with everybody in turns.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "cli/bench_cases.hpp"
#include "cli/bench_result.hpp"
#include "cli/bench_views.hpp"

namespace tureen::cli {

struct MeasureOptions {
  int rounds = 5;
  double max_seconds = 0;                   // for all together; 0: no limit
  std::function<double()> clock = nullptr;  // of BenchmarkOptions
  std::filesystem::path folder;  // of the pictures that prove what was timed; empty: none
};

/// One after the other, case by case within each. Shows progress; throws Interrupted
/// after Ctrl-C, DeviceLimitError for a size that the device does not draw and OutputError.
std::vector<BenchMeasurement> measure(const BenchCases& cases, const std::vector<BenchViews>& views,
                                      const MeasureOptions& options);

}  // namespace tureen::cli
