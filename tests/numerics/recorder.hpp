// Measurements of a test of numerics, each with its assertion.
//
// A case is one way in which numbers go wrong, stressed by one parameter. At each value of the
// parameter stands the error of our form, the error that it may have, and, where the catalogue of
// hazards names one, the error of the naive form. Our error must never exceed the tolerance; the
// naive one must somewhere, or nothing would be lost by going back to it; and where the catalogue
// says from which stress on, it must there.
//
// `./dev numerics` sets TUREEN_MEASURED to a file, to which every case appends a line of JSON.
// "The catalogue" in these tests is the list of hazards in docs/numerics.md, which names the cases.
// Where a bound is called the catalogue's, it was set before this code was written, by the reason
// that the test gives beside it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tureen::test {

/// The larger error; one that is no number is infinite. (std::max would lose it.)
inline double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::infinity() : std::max(a, b);
}

struct Case {
  std::string stressed;    // in a few words: "vertices and eye far from the origin"
  std::string parameter;   // the stress, with its unit: "offset / units"
  std::string unit;        // of the errors: "pixels"
  std::string naive = {};  // what the naive form does; empty where there is none
  /// From this parameter on the naive error must exceed the tolerance, every time.
  std::optional<double> naive_fails_from = {};
  /// And below this one never: where the form is as good as ours up to its limit.
  std::optional<double> naive_holds_below = {};
};

struct Measurement {
  double at = 0;                     // the parameter
  std::optional<double> naive = {};  // infinite where it gives no number at all
  double ours = 0;
  double tolerance = 0;
};

/// One case of the running test, which may have several.
class Recorder {
 public:
  explicit Recorder(Case what);
  /// Asserts that the naive form failed, where there is one, and that there were measurements to
  /// either side of where it is said to; and writes the line.
  ~Recorder();  // NOLINT(bugprone-exception-escape), see there
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Expects that `ours` is a number and at most the tolerance, and of `naive` what the case says.
  void add(const Measurement& measured);

 private:
  void write() const;

  Case case_;
  std::vector<Measurement> measurements_;
};

}  // namespace tureen::test
