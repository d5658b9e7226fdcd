#include "formats/decimal.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace tureen {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

constexpr bool is_digit(char c) { return static_cast<unsigned char>(c - '0') <= 9; }

/// Powers of ten that a double holds exactly.
constexpr std::array<double, 23> exact_power{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                             1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                             1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// value * 10^exponent, with a relative error of at most 2^-53 a step of 10^22. Over- and
/// underflow of the double are the caller's to exclude.
double scaled(double value, int exponent) {
  for (; exponent > 22; exponent -= 22) value *= exact_power[22];
  for (; exponent < -22; exponent += 22) value /= exact_power[22];
  return exponent >= 0 ? value * exact_power[std::size_t(exponent)]
                       : value / exact_power[std::size_t(-exponent)];
}

/// A whole number of up to 1,024 bits, little end first. The largest that we compare are
/// 10^(max_digits) and midpoints scaled by 10^(max_digits + 45): under 600 bits.
class Big {
 public:
  explicit Big(std::uint64_t value) {
    limbs_[0] = static_cast<std::uint32_t>(value);
    limbs_[1] = static_cast<std::uint32_t>(value >> 32);
  }

  void multiply_add(std::uint32_t factor, std::uint32_t addend) {
    std::uint64_t carry = addend;
    for (std::uint32_t& limb : limbs_) {
      carry += std::uint64_t(limb) * factor;
      limb = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    assert(carry == 0);
  }

  void multiply_power_of_ten(int exponent) {
    for (; exponent >= 9; exponent -= 9) multiply_add(1000000000u, 0);
    for (; exponent > 0; --exponent) multiply_add(10u, 0);
  }

  void shift_left(int bits) {
    for (; bits >= 16; bits -= 16) multiply_add(1u << 16, 0);
    multiply_add(1u << bits, 0);
  }

  /// -1, 0 or 1 for less, equal, greater.
  int compare(const Big& other) const {
    for (std::size_t i = limbs_.size(); i-- > 0;)
      if (limbs_[i] != other.limbs_[i]) return limbs_[i] < other.limbs_[i] ? -1 : 1;
    return 0;
  }

 private:
  std::array<std::uint32_t, 32> limbs_{};
};

/// The significant digits of a number as they stand in the text: `count` digits (a point among
/// them is passed over), the last of which has the weight 10^exponent.
struct Digits {
  const char* first;
  std::size_t count;
  long long exponent;
};

/// Midpoints of two floats have at most 113 significant digits, so beyond this many it only matters
/// whether anything but zeros follows.
constexpr std::size_t max_digits = 120;

/// The decimal value compared with `midpoint` > 0, exactly. The value is near the midpoint, so
/// neither number is large.
int compare_exactly(const Digits& digits, double midpoint) {
  Big left(0);
  std::size_t seen = 0;
  bool rest = false;
  const char* c = digits.first;
  for (; seen < digits.count; ++c) {
    if (*c == '.') continue;
    if (seen < max_digits)
      left.multiply_add(10, static_cast<std::uint32_t>(*c - '0'));
    else if (*c != '0')
      rest = true;
    ++seen;
  }
  long long exponent = digits.exponent;
  if (seen > max_digits) {
    // The digits left out weigh less than one unit of the last kept: a 1 after it orders the same.
    exponent += static_cast<long long>(seen - max_digits) - 1;
    left.multiply_add(10, rest ? 1 : 0);
  }
  int binary = 0;
  const double mantissa = std::frexp(midpoint, &binary);
  Big right(static_cast<std::uint64_t>(std::ldexp(mantissa, 53)));
  binary -= 53;
  if (exponent >= 0)
    left.multiply_power_of_ten(static_cast<int>(exponent));
  else
    right.multiply_power_of_ten(static_cast<int>(-exponent));
  if (binary >= 0)
    right.shift_left(binary);
  else
    left.shift_left(-binary);
  return left.compare(right);
}

/// The float nearest to a value near `approximate`, which is off by a few units in its last place.
float nearest_float(double approximate, const Digits& digits) {
  if (approximate >= 0x1p128) return infinity;
  // Relative: 2^-53 for the mantissa, 2^-53 for each of up to three steps of scaled(), 2^-59 for
  // the digits beyond the nineteenth; 2^-50 covers them almost twice.
  const double doubt = approximate * 0x1p-50;
  const float nearest = static_cast<float>(approximate);
  // Where the next float up is infinite, rounding works as if it were 2^128.
  const auto as_double = [](float f) { return f == infinity ? 0x1p128 : double(f); };
  const float other = double(nearest) > approximate || nearest == infinity
                          ? std::nextafter(nearest, 0.0f)
                          : std::nextafter(nearest, infinity);
  const double midpoint = 0.5 * (as_double(nearest) + as_double(other));
  if (std::abs(approximate - midpoint) > doubt) return nearest;
  const float low = std::min(nearest, other), high = std::max(nearest, other);
  const int order = compare_exactly(digits, midpoint);
  if (order != 0) return order < 0 ? low : high;
  std::uint32_t low_bits = 0;
  std::memcpy(&low_bits, &low, sizeof low);
  return low_bits % 2 == 0 ? low : high;
}

/// mantissa * 10^exponent where mantissa is the first (up to 19) of `digits`, at the exponent that
/// belongs to it.
float to_float(std::uint64_t mantissa, long long exponent, const Digits& digits) {
  if (mantissa == 0) return 0.0f;
  // Nineteen digits at most: the value lies in [10^exponent, 10^(exponent + 19)).
  if (exponent > 38) return infinity;
  if (exponent < -65) return 0.0f;  // below 1e-46 < 2^-150
  const double approximate = scaled(static_cast<double>(mantissa), static_cast<int>(exponent));
  std::uint64_t bits = 0;
  std::memcpy(&bits, &approximate, sizeof bits);
  // Between 2^-126 and 2^127 floats are doubles whose last 29 bits are 0 and midpoints are those
  // whose last 29 bits are 2^28: outside 16 double units around it the plain cast is right.
  const std::uint64_t last = bits & 0x1fffffffu;
  const bool doubtful = last - 0x0ffffff0u <= 0x20u;
  if (!doubtful && approximate >= 0x1p-126 && approximate < 0x1p127)
    return static_cast<float>(approximate);
  return nearest_float(approximate, digits);
}

/// Whether the lower-case `word` stands at `text` in any case.
bool stands_at(const char* text, const char* word) {
  for (; *word; ++text, ++word)
    if ((*text | 0x20) != *word) return false;
  return true;
}

}  // namespace

Decimal parse_decimal(const char* text) {
  Decimal result;
  const char* c = text;
  const bool negative = *c == '-';
  if (*c == '-' || *c == '+') ++c;

  if (!is_digit(*c) && *c != '.') {
    if (stands_at(c, "nan")) {
      result.value = std::numeric_limits<float>::quiet_NaN();
      result.end = c + 3;
    } else if (stands_at(c, "inf")) {
      result.value = negative ? -infinity : infinity;
      result.end = c + (stands_at(c, "infinity") ? 8 : 3);
    }
    return result;
  }

  // Leading zeros carry no weight and do not count among the nineteen digits of the mantissa.
  bool any = false, point = false;
  long long exponent = 0;
  std::uint64_t mantissa = 0;
  while (*c == '0') ++c, any = true;
  if (*c == '.') {
    point = true;
    ++c;
    while (*c == '0') ++c, --exponent, any = true;
  }
  Digits digits{c, 0, 0};
  long long left_out = 0;
  for (;; ++c) {
    if (is_digit(*c)) {
      if (digits.count < 19)
        mantissa = mantissa * 10 + static_cast<std::uint64_t>(*c - '0');
      else
        ++left_out;
      ++digits.count;
      exponent -= point;
    } else if (*c == '.' && !point) {
      point = true;
    } else {
      break;
    }
  }
  if (!any && digits.count == 0) return result;  // a lone point
  result.is_integer = !point;

  if ((*c | 0x20) == 'e') {
    const char* e = c + 1;
    const bool down = *e == '-';
    if (*e == '-' || *e == '+') ++e;
    if (is_digit(*e)) {
      // Saturates far beyond what any number of digits in memory could bring back.
      constexpr long long huge = std::numeric_limits<long long>::max() / 4;
      long long written = 0;
      for (; is_digit(*e); ++e)
        if (written < huge / 10) written = written * 10 + (*e - '0');
      exponent += down ? -written : written;
      result.is_integer = false;
      c = e;
    }
  }
  digits.exponent = exponent;
  const float magnitude = to_float(mantissa, exponent + left_out, digits);
  result.value = negative ? -magnitude : magnitude;
  result.end = c;
  return result;
}

Integer parse_integer(const char* text) {
  const char* c = text;
  const bool negative = *c == '-';
  if (*c == '-' || *c == '+') ++c;
  if (!is_digit(*c)) return {};
  constexpr long long most = std::numeric_limits<long long>::max();
  long long value = 0;
  for (; is_digit(*c); ++c) {
    const int digit = *c - '0';
    if (value > (most - digit) / 10) return {};
    value = value * 10 + digit;
  }
  return {negative ? -value : value, c};
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

/// Writes digits * 10^exponent, as 123.45 where that is short and as 1.2345e-7 elsewhere.
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
  if (std::isnan(value)) return static_cast<char*>(std::memcpy(out, "nan", 3)) + 3;
  if (std::signbit(value)) {
    *out++ = '-';
    value = -value;
  }
  if (value == infinity) return static_cast<char*>(std::memcpy(out, "inf", 3)) + 3;
  if (value == 0.0f) {
    *out++ = '0';
    return out;
  }
  // Nine digits always suffice, even if the last were not rounded perfectly: they lie at least
  // 10^8 / 2^24 = 5.9 times as close together as floats do. The logarithm cannot reach the next
  // integer by rounding, for the largest float below a power of ten is 3e-8 of its size away.
  const double exact = value;
  int leading = static_cast<int>(std::floor(std::log10(exact)));
  for (int wanted = 6; wanted <= 9; ++wanted) {
    const Rounded candidate = rounded(exact, leading, wanted);
    char text[24];
    char* end = text + sizeof text;
    char* first = end;
    for (std::uint64_t rest = candidate.digits; rest > 0; rest /= 10)
      *--first = static_cast<char>('0' + rest % 10);
    const Digits digits{first, static_cast<std::size_t>(end - first), candidate.exponent};
    if (wanted == 9 || to_float(candidate.digits, candidate.exponent, digits) == value)
      return write_digits(out, candidate.digits, candidate.exponent);
  }
  return out;  // not reached
}

std::string float_text(float value) {
  char text[max_float_text];
  return std::string(text, format_float(text, value));
}

}  // namespace tureen
