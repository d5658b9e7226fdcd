// Two results of `tureen bench` side by side: what became faster or slower, and whether the two can
// be compared at all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/bench_result.hpp"

namespace tureen::cli {

/// What both results measured: one configuration with one set of cameras at one size.
struct BenchRatio {
  std::string configuration, camera_set, size;
  double then_ms = 0, now_ms = 0;     // min_of_medians
  double ratio = 1;                   // now / then: above 1 is slower
  std::optional<double> spread = {};  // spread_between() the two, with the larger A/A spread
  Verdict verdict = Verdict::unknown;
  int rounds = 0;            // of the shorter of the two
  bool same_pixels = false;  // the two drew the same picture, bit for bit
};

struct BenchComparison {
  /// In the order of the new result. None, as nothing unmatched, where the first of `circumstances`
  /// says that the two are not to be compared: software and hardware, or different clocks.
  std::vector<BenchRatio> ratios;
  /// Sentences on what else than the program changed or may have: scene, machine, driver, commit,
  /// build. What an older file does not tell is no change.
  std::vector<std::string> circumstances;
  /// What only one of the two measured, a line each.
  std::vector<std::string> unmatched;
};

BenchComparison compare_benches(const BenchResult& now, const BenchResult& then);

/// Those that are slower by more than `percent`, and by more than their spread explains.
std::vector<BenchRatio> slower_than(const BenchComparison& comparison, double percent);

/// The member `comparison` of docs/json.md; `against` is the file of the earlier result.
Json to_json(const BenchComparison& comparison, const std::string& against);

/// Lines of text, a table first; for a terminal.
std::vector<std::string> comparison_lines(const BenchComparison& comparison);

}  // namespace tureen::cli
