// Two results of a benchmark side by side: what became faster or slower, and whether the two can be
// compared at all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "jobs/bench/bench_result.hpp"

namespace tureen {

/// A measurement that both results have: one configuration with one set of cameras at one size.
struct BenchRatio {
  std::string configuration, camera_set, size;
  double then_ms = 0, now_ms = 0;     // min_of_medians
  double ratio = 1;                   // now / then: above 1 is slower
  std::optional<double> spread = {};  // spread_between() the two, with the larger A/A spread
  Verdict verdict = Verdict::unknown;
  int rounds = 0;            // of the shorter of the two
  bool same_pixels = false;  // the two drew the same image, bit for bit
};

/// Why times of two results say nothing of each other.
enum class Incomparable { software, clock };  // one drawn in software; different clocks

/// Something else than the program that differs.
struct BenchChange {
  enum class What { scene, machine, driver, context, rasteriser_threads, build, commit, clock };
  What what{};
  std::string then, now;
};

/// A measurement that only one of the two results has.
struct UnmatchedBench {
  enum class In { now, then };
  In in{};
  BenchMeasurement measurement;
};

struct BenchComparison {
  std::optional<Incomparable> incomparable;
  /// In the order of the new result. None, as nothing unmatched, where they are incomparable.
  std::vector<BenchRatio> ratios;
  /// In the order of BenchChange::What. A field that an older file lacks is no change.
  std::vector<BenchChange> changes;
  std::vector<UnmatchedBench> unmatched;
};

BenchComparison compare_benches(const BenchResult& now, const BenchResult& then);

/// Those that are slower by more than `percent`, and by more than their spread explains.
std::vector<BenchRatio> slower_than(const BenchComparison& comparison, double percent);

}  // namespace tureen
