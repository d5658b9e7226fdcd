// The allowed numbers of a training constant, and the reason for the limits.
#pragma once

#include <string>

namespace tureen::trainer {

struct Range {
  enum class Ends { closed, low_open, high_open };
  double low = 0;
  double high = 0;
  Ends ends = Ends::closed;
  const char* reason = "";
  const char* reason_above = reason;  // the reason for numbers above `high`, if it differs

  bool contains(double value) const;
  /// "from 1 to 1024"; for an open end "more than 0, at most 1" or "from 0 to less than 1".
  std::string text() const;
  /// The error for a value outside the range: "0 is out of range; allowed: from 1 to 1024 (..)".
  /// `written`: the value as text in the file or on the command line.
  std::string refusal(double value, const std::string& written) const;
};

/// The ranges of constants that several methods have.
namespace ranges {
// Larger whole numbers are probably typing errors.
inline constexpr Range whole{
    1, 1e7, {}, "a run needs at least one step", "the run would take weeks"};
inline constexpr Range minutes{0,
                               1e5,
                               {},
                               "the value is a time, or 0 for a fixed number of steps",
                               "the run would take months"};
inline constexpr Range fraction{0, 1, {}, "the value is a fraction"};
inline constexpr Range weight{0, 1000, {}, "a negative weight would increase the error"};
inline constexpr Range color{0, 1, {}, "the value is a display-referred colour"};
// 2^64 - 1 is not a double, so the range ends at 2^64; it contains all values of the type.
inline constexpr Range any_seed{
    0, 18446744073709551616.0, {}, "the seed is an unsigned number of 64 bits"};
inline constexpr Range none{};
}  // namespace ranges

/// The shortest decimal that reads back as the same number.
std::string double_text(double value);

}  // namespace tureen::trainer
