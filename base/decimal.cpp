#include "base/decimal.hpp"

#ifndef __EMSCRIPTEN__
#define FASTFLOAT_ALLOWS_LEADING_PLUS 1
#include <fast_float/fast_float.h>
#endif

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace tureen {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Powers of ten that a double holds exactly.
constexpr std::array<double, 23> exact_power{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                             1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                             1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// value * 10^exponent, with a relative error of at most 2^-53 per step of 10^22. The caller
/// excludes overflow and underflow of the double.
double scaled(double value, int exponent) {
  for (; exponent > 22; exponent -= 22) value *= exact_power[22];
  for (; exponent < -22; exponent += 22) value /= exact_power[22];
  return exponent >= 0 ? value * exact_power[std::size_t(exponent)]
                       : value / exact_power[std::size_t(-exponent)];
}

/// One past the number at the start of `text`, or null.
const char* parse(std::string_view text, float& value) {
#ifdef __EMSCRIPTEN__
  // fast_float's tables and code take 18 KB with brotli. The engine contains strtof anyway, for
  // JSON, and has only one locale. strtof would also skip blanks and read hexadecimal numbers.
  const char* first = text.data();
  if (std::isspace(static_cast<unsigned char>(*first))) return nullptr;
  const char* digits = first + (*first == '-' || *first == '+');
  if (digits[0] == '0' && (digits[1] | 0x20) == 'x') {
    value = *first == '-' ? -0.0f : 0.0f;
    return digits + 1;
  }
  char* end = nullptr;
  value = std::strtof(first, &end);
  return end == first ? nullptr : end;
#else
  const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), value);
  // Newer versions report overflow and underflow, but still set infinity or zero.
  return error == std::errc::invalid_argument ? nullptr : end;
#endif
}

}  // namespace

Decimal parse_decimal(std::string_view text) {
  Decimal result;
  result.end = parse(text, result.value);
  if (!result.end) return {};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool has_sign = text.front() == '-' || text.front() == '+';
  result.is_integer = std::all_of(text.data() + has_sign, result.end, is_digit);
  return result;
}

Integer parse_integer(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Integer result;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), result.value);
  if (error == std::errc()) result.end = stop;
  return result;
}

namespace {

/// A float's first digits: value ~ digits * 10^exponent with at most `wanted` digits.
struct Rounded {
  std::uint64_t digits;
  int exponent;
};

Rounded rounded(double value, int leading_exponent, int wanted) {
  const int exponent = leading_exponent - wanted + 1;
  return {static_cast<std::uint64_t>(scaled(value, -exponent) + 0.5), exponent};
}

/// Writes digits * 10^exponent: as 123.45 for leading exponents -5..8, else as 1.2345e-7.
char* write_digits(char* out, std::uint64_t digits, int exponent) {
  while (digits % 10 == 0) digits /= 10, ++exponent;
  char text[20];
  int count = 0;
  for (; digits > 0; digits /= 10) text[19 - count++] = static_cast<char>('0' + digits % 10);
  const char* first = text + 20 - count;
  const int leading = exponent + count - 1;  // the exponent of the first digit
  if (leading < -5 || leading > 8) {
    *out++ = *first;
    if (count > 1) {
      *out++ = '.';
      for (int i = 1; i < count; ++i) *out++ = first[i];
    }
    *out++ = 'e';
    if (leading < 0) *out++ = '-';
    const int magnitude = std::abs(leading);
    if (magnitude >= 10) *out++ = static_cast<char>('0' + magnitude / 10);
    *out++ = static_cast<char>('0' + magnitude % 10);
    return out;
  }
  if (leading < 0) {
    *out++ = '0';
    *out++ = '.';
    for (int i = -1; i > leading; --i) *out++ = '0';
    for (int i = 0; i < count; ++i) *out++ = first[i];
    return out;
  }
  for (int i = 0; i < count || i <= leading; ++i) {
    if (i == leading + 1) *out++ = '.';
    *out++ = i < count ? first[i] : '0';
  }
  return out;
}

}  // namespace

char* format_float(char* out, float value) {
  if (std::isnan(value)) return static_cast<char*>(std::memcpy(out, "nan", 4)) + 3;
  if (std::signbit(value)) {
    *out++ = '-';
    value = -value;
  }
  if (value == infinity) return static_cast<char*>(std::memcpy(out, "inf", 4)) + 3;
  if (value == 0.0f) return static_cast<char*>(std::memcpy(out, "0", 2)) + 1;
  // Nine digits always suffice, even with an imperfectly rounded last digit: nine-digit decimals
  // lie at least 10^8 / 2^24 = 5.9 times as close together as floats. The logarithm cannot round
  // up to the next integer: the largest float below a power of ten is 3e-8 of its size away.
  const double exact = value;
  int leading = static_cast<int>(std::floor(std::log10(exact)));
  for (int wanted = 6;; ++wanted) {
    const Rounded candidate = rounded(exact, leading, wanted);
    char* end = write_digits(out, candidate.digits, candidate.exponent);
    *end = '\0';
    if (wanted == 9 || parse_decimal({out, std::size_t(end - out)}).value == value) return end;
  }
}

std::string float_text(float value) {
  char text[max_float_text];
  return std::string(text, format_float(text, value));
}

}  // namespace tureen
