// Compares two results of a benchmark: ratios of times, other changes, and whether the two are
// comparable.
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
  std::optional<double> spread = {};  // spread_between() both, with the larger A/A spread
  Verdict verdict = Verdict::unknown;
  int rounds = 0;            // the smaller number of both results
  bool same_pixels = false;  // whether both drew the same image, bit for bit
};

/// The reason why the times of two results are not comparable.
enum class Incomparable { software, clock };  // one drawn in software; different clocks

/// A difference between the results other than times.
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
  /// In the order of the new result. If the results are incomparable, `ratios` and `unmatched` are
  /// empty.
  std::vector<BenchRatio> ratios;
  /// In the order of BenchChange::What. A field that an older file lacks is not a change.
  std::vector<BenchChange> changes;
  std::vector<UnmatchedBench> unmatched;
};

BenchComparison compare_benches(const BenchResult& now, const BenchResult& then);

/// The ratios that are slower by more than `percent` and have Verdict::slower.
std::vector<BenchRatio> slower_than(const BenchComparison& comparison, double percent);

}  // namespace tureen
