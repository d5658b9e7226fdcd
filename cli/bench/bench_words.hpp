// Words of `tureen bench`: whether a ratio means anything, what is not known, where it was
// measured.
#pragma once

#include <string>

#include "jobs/bench/bench_result.hpp"

namespace tureen::cli {

/// In place of a figure that is not known.
inline constexpr const char* not_known = "–";

/// A ratio of two measurements of one run, where it means something: "5.20". Else its verdict.
std::string ratio_text(double ratio, const BenchMeasurement& a, const BenchMeasurement& b);

/// The verdict's name, or "1 round" if it is unknown; `rounds` is the smaller of the two.
std::string verdict_text(Verdict verdict, int rounds);

/// `figure` of p99 or the 1 % low; not_known where that is the slowest sample and nothing more.
std::string slowest_percent_text(const FrameStatistics& ms, const std::string& figure);

/// "1 round", "3 rounds".
std::string count_text(int count, const char* what);

/// "Some CPU, 2 cores, 2 rasteriser threads".
std::string machine_text(const Machine& machine);

}  // namespace tureen::cli
