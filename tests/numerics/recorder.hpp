// Measurements of a test of numerics, each with its assertion.
//
// A case is one numerical failure, provoked at several values of one parameter. Each measurement
// has our error, the allowed error and, where the catalogue of hazards names a naive method, its
// error. Our error must never exceed the tolerance. The naive error must exceed it at least once,
// which shows that our method is needed; from a value that the catalogue gives, it must always
// exceed it.
//
// `./dev numerics` sets TUREEN_MEASURED to a file, to which every case appends a line of JSON. "The
// catalogue" in these tests is the list of hazards in docs/numerics.md, which names the cases. A
// bound from the catalogue was set before this code was written; the test gives its reason.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tureen::test {

/// The larger error; not a number counts as infinite. (std::max would lose it.)
inline double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::infinity() : std::max(a, b);
}

struct Case {
  std::string stressed;    // a short phrase: "vertices and eye far from the origin"
  std::string parameter;   // with its unit: "offset / units"
  std::string unit;        // of the errors: "pixels"
  std::string naive = {};  // the naive method; empty if none
  /// From this parameter on, the naive error must always exceed the tolerance.
  std::optional<double> naive_fails_from = {};
  /// Below this parameter it must never exceed it: the naive method is as good as ours up to its
  /// limit.
  std::optional<double> naive_holds_below = {};
};

struct Measurement {
  double at = 0;                     // the parameter
  std::optional<double> naive = {};  // infinite if the result is not finite
  double ours = 0;
  double tolerance = 0;
};

/// One case of the running test, which may have several.
class Recorder {
 public:
  explicit Recorder(Case what);
  /// Asserts that a naive method failed at least once, and that there were measurements on both
  /// sides of its limits. Writes the line.
  ~Recorder();  // NOLINT(bugprone-exception-escape), see there
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Expects that `ours` is finite and at most the tolerance, and that `naive` is as the case
  /// requires.
  void add(const Measurement& measured);

 private:
  void write() const;

  Case case_;
  std::vector<Measurement> measurements_;
};

}  // namespace tureen::test
