// Floats to and from decimal text, the same in every locale and on every platform: what strtof and
// printf do, without their locale, and fast enough for files of gigabytes: fast_float parses
// (D. Lemire, "Number parsing at a gigabyte per second", 2021).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tureen {

/// A number as it stands in a text.
struct Decimal {
  /// The float nearest to the decimal value, ties to even: correctly rounded at once, with no
  /// double in between. Infinite from 2^128 - 2^103 on, zero up to and including 2^-150.
  float value = 0.0f;
  /// Digits alone, with or without a sign: no point, no exponent, not a word. The caller who needs
  /// the integer beyond 2^24 parses it with parse_integer.
  bool is_integer = false;
  /// One past the last character, or null where no number begins.
  const char* end = nullptr;
};

/// The number with which `text` begins. Reads [+-]digits[.digits][e[+-]digits], at least one digit,
/// and the words nan, inf and infinity in any case, nan also as some C libraries print it:
/// nan(ind). Any number of digits is honoured. Not hexadecimal. The text is followed by a NUL, or
/// by another character that cannot belong to a number.
Decimal parse_decimal(std::string_view text);

/// An integer with an optional sign; `end` null where none begins or it overflows 64 bits.
struct Integer {
  long long value = 0;
  const char* end = nullptr;
};
Integer parse_integer(std::string_view text);

/// The longest text that format_float writes, with its NUL.
inline constexpr std::size_t max_float_text = 17;

/// Writes `value` with at most 9 significant digits so that parse_decimal gives back the same bits
/// (any NaN as "nan"), trying 6, 7 and 8 digits first, and a NUL. Returns where the NUL is.
char* format_float(char* out, float value);

/// format_float as a string, for messages.
std::string float_text(float value);

}  // namespace tureen
