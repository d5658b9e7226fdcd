// Floats to and from decimal text, the same in every locale and on every platform. The functions
// replace strtof and printf, which depend on the locale. fast_float parses fast enough for files of
// gigabytes (D. Lemire, "Number parsing at a gigabyte per second", 2021).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tureen {

/// A number read from a text.
struct Decimal {
  /// The float nearest to the decimal value, ties to even: rounded once, without a double in
  /// between. Infinite from 2^128 - 2^103 on, zero up to and including 2^-150.
  float value = 0.0f;
  /// Whether the text has only digits and an optional sign: no point, no exponent, no word.
  /// parse_integer reads integers beyond 2^24 exactly.
  bool is_integer = false;
  /// One past the last character, or null if no number begins here.
  const char* end = nullptr;
};

/// Parses the number at the start of `text`. Reads [+-]digits[.digits][e[+-]digits] with at least
/// one digit. Reads the words nan, inf and infinity in any case, and nan(ind), which some C
/// libraries print. The number of digits is unlimited. Hexadecimal is not supported. The text must
/// be followed by a NUL or by another character that cannot belong to a number.
Decimal parse_decimal(std::string_view text);

/// An integer with an optional sign. `end` is null if none begins here or it overflows 64 bits.
struct Integer {
  long long value = 0;
  const char* end = nullptr;
};
Integer parse_integer(std::string_view text);

/// Size of the longest text that format_float writes, including its NUL.
inline constexpr std::size_t max_float_text = 17;

/// Writes `value` and a NUL with the fewest digits of 6, 7, 8 and 9 that parse_decimal reads back
/// to the same bits (any NaN as "nan"). Returns the position of the NUL.
char* format_float(char* out, float value);

/// format_float as a string, for messages.
std::string float_text(float value);

}  // namespace tureen
