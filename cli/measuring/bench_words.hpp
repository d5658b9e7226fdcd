// Texts of `tureen bench`: ratios and verdicts, unknown values, counts, and the machine.
#pragma once

#include <string>

#include "jobs/bench/bench_result.hpp"

namespace tureen::cli {

/// Text for an unknown value.
inline constexpr const char* not_known = "–";

/// The ratio of two measurements in one run, such as "5.20". If the difference is within the noise
/// or unknown, the text of its verdict.
std::string ratio_text(double ratio, const BenchMeasurement& a, const BenchMeasurement& b);

/// The verdict's name, or "1 round" if it is unknown; `rounds` is the smaller of the two.
std::string verdict_text(Verdict verdict, int rounds);

/// `figure`, the p99 or the 1 % low; not_known with fewer than 100 samples.
std::string slowest_percent_text(const FrameStatistics& ms, const std::string& figure);

/// "1 round", "3 rounds".
std::string count_text(int count, const char* what);

/// "Some CPU, 2 cores, 2 rasteriser threads".
std::string machine_text(const Machine& machine);

}  // namespace tureen::cli
