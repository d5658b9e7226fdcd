// What every report of `tureen bench` says alike: which ratios there are and whether they mean
// anything, what is not known, and where it was measured.
#pragma once

#include <string>

#include "cli/bench_result.hpp"

namespace tureen::cli {

/// In place of a figure that is not known.
inline constexpr const char* not_known = "–";

/// Behind what was timed before its warm-up had come to rest, and the sentence under such a table.
inline constexpr const char* restless_mark = "†";
inline constexpr const char* restless_sentence =
    "† Its warm-up had not come to rest when times began to count.";

/// What tables have in place of ratios.
inline constexpr const char* ratio_sentence =
    "\"equal\" is what differs by less than twice the spread, the largest of the A/A spread and of "
    "those of both rows' rounds; of fewer than 3 rounds none is known.";

/// The configuration that ratios are taken of: "published" where it was measured, else the first.
std::string reference_configuration(const BenchResult& result);

/// The reference in the same place; nullptr where that was not measured.
const BenchMeasurement* reference_of(const BenchResult& result,
                                     const BenchMeasurement& measurement);

/// How many times as fast as the reference in the same place; 0 where that was not measured.
double times_as_fast(const BenchResult& result, const BenchMeasurement& measurement);

/// The same for a table: "1.00" of the reference itself, empty where it was not measured, and else
/// as ratio_text.
std::string times_as_fast_text(const BenchResult& result, const BenchMeasurement& measurement);

/// A ratio of two measurements of one run, where it means something: "5.20". Else its verdict.
std::string ratio_text(double ratio, const BenchMeasurement& a, const BenchMeasurement& b);

/// "unknown", "equal", "faster", "slower".
const char* verdict_word(Verdict verdict);

/// The same, but "1 round" where that is not known, of the one of the two that has
/// fewer `rounds`.
std::string verdict_text(Verdict verdict, int rounds);

/// How far the medians of its rounds lie apart, "1.3 %"; not_known of fewer than least_rounds.
std::string spread_text(const FrameStatistics& ms);

/// `figure` of p99 or the 1 % low; not_known where that is the slowest sample and nothing more.
std::string slowest_percent_text(const FrameStatistics& ms, const std::string& figure);

/// "1 round", "3 rounds".
std::string count_text(int count, const char* what);

/// "Some CPU, 2 cores, 2 rasteriser threads".
std::string machine_text(const Machine& machine);

/// "commit abc1234, release build".
std::string build_text(const BenchProgram& program);

}  // namespace tureen::cli
