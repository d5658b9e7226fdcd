// Our float parser and writer against strtof and printf of the C library, which are correct, but
// slow and dependent on the locale.
#include "base/decimal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

namespace tureen {
namespace decimal_test {

std::uint32_t bits_of(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

float float_of(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

void expect_as_strtof(const std::string& text) {
  char* end = nullptr;
  const float expected = std::strtof(text.c_str(), &end);
  const Decimal got = parse_decimal(text.c_str());
  ASSERT_NE(got.end, nullptr) << text;
  EXPECT_EQ(got.end, end) << text;
  EXPECT_EQ(bits_of(got.value), bits_of(expected))
      << text << ": " << got.value << " instead of " << expected;
}

/// The exact decimal expansion of `value`, without rounding.
std::string exact_text(double value) {
  char text[1200];
  std::snprintf(text, sizeof text, "%.1080f", value);
  std::string s = text;
  s.erase(s.find_last_not_of('0') + 1);
  return s;
}

TEST(ParseDecimal, AgreesWithStrtofOnNastyTexts) {
  for (const char* text :
       {"0",
        "-0",
        "+0.0",
        "0e99999999999999999999",
        "1",
        "-1",
        "+1.5",
        ".5",
        "5.",
        "-.25e1",
        "0.1",
        "0.30000001192092896",
        "16777216",
        "16777217",
        "16777218",
        "16777219",
        "3.4028234663852886e38",
        "3.4028235677973366e38",
        "340282356779733661637539395458142568447",
        "340282356779733661637539395458142568448",
        "3.4028236e38",
        "1e39",
        "1e999",
        "-1e999",
        "1e-999",
        "1.17549435e-38",
        "1.1754942e-38",
        "1.401298464324817e-45",
        "7.0064923e-46",
        "7.00649232162408535461864791644958065640130970938257885878534141944895541342930300743319e-"
        "46",
        "7.00649232162408535461864791644958065640130970938257885878534141944895541342930300743320e-"
        "46",
        "0.000000000000000000000000000000000000000000000000000000000000000000000000000000000001",
        "100000000000000000000000000000000000000",
        "1000000000000000000000000000000000000000",
        "9007199254740993",
        "18446744073709551615",
        "18446744073709551616",
        "1e5x",
        "1e",
        "1e+",
        "1.5.5",
        "12345678901234567890123456789012345678",
        "8388609.5",
        "8388610.5",
        "1e-0000000000000000000000000000000000000001"})
    expect_as_strtof(text);
}

TEST(ParseDecimal, ReadsWords) {
  EXPECT_TRUE(std::isnan(parse_decimal("nan").value));
  EXPECT_TRUE(std::isnan(parse_decimal("-NaN ").value));
  EXPECT_EQ(parse_decimal("inf").value, INFINITY);
  EXPECT_EQ(parse_decimal("-Infinity").value, -INFINITY);
  EXPECT_TRUE(std::isnan(parse_decimal("nan(ind)").value));
  const char* text = "infinit";
  EXPECT_EQ(parse_decimal(text).end, text + 3);
}

TEST(ParseDecimal, RefusesWhatIsNoNumber) {
  for (const char* text :
       {"", "-", "+", ".", "-.", "e5", ".e5", "x", "--1", "+-1", "na", "in", " 1"})
    EXPECT_EQ(parse_decimal(text).end, nullptr) << "'" << text << "'";
}

TEST(ParseDecimal, HexadecimalNumbersEndBeforeTheirX) {
  const char* text = "-0x10";
  EXPECT_EQ(parse_decimal(text).end, text + 2);
  EXPECT_EQ(bits_of(parse_decimal(text).value), bits_of(-0.0f));
}

TEST(ParseDecimal, KnowsIntegers) {
  EXPECT_TRUE(parse_decimal("255").is_integer);
  EXPECT_TRUE(parse_decimal("-3").is_integer);
  for (const char* text : {"1.", "1.0", "1e0", ".0", "nan", "inf"})
    EXPECT_FALSE(parse_decimal(text).is_integer) << text;
}

TEST(ParseDecimal, AgreesWithStrtofOnRandomDigits_seed1) {
  std::mt19937_64 random(1);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  for (int i = 0; i < 200000; ++i) {
    std::string text = below(2) ? "-" : "";
    const auto digits = 1 + below(below(10) ? 20 : 200);
    const auto point = below(digits + 1);
    for (std::uint64_t d = 0; d < digits; ++d) {
      if (d == point) text += '.';
      text += char('0' + below(10));
    }
    if (below(2)) text += "e" + std::to_string(int(below(120)) - 70);
    expect_as_strtof(text);
    if (HasFailure()) break;
  }
}

TEST(ParseDecimal, AgreesWithStrtofAtAndAroundEveryKindOfMidpoint_seed2) {
  std::mt19937 random(2);
  for (int i = 0; i < 5000; ++i) {
    // Every tenth number is subnormal. The upper neighbour of the largest finite float counts as
    // 2^128.
    std::uint32_t bits = random() % 0x7f800000u;
    if (i % 10 == 0) bits %= 0x00800000u;
    if (i == 1) bits = 0x7f7fffffu;
    const double low = float_of(bits);
    const double high = bits == 0x7f7fffffu ? 0x1p128 : double(float_of(bits + 1));
    const std::string middle = exact_text(0.5 * (low + high));
    expect_as_strtof(middle);
    // Slightly more, with a digit far beyond the relevant ones, and slightly less.
    const std::string point = middle.find('.') == std::string::npos ? "." : "";
    expect_as_strtof(middle + point + std::string(300, '0') + "1");
    expect_as_strtof(exact_text(std::nextafter(0.5 * (low + high), 0.0)));
    expect_as_strtof(exact_text(std::nextafter(0.5 * (low + high), INFINITY)));
    std::string less = middle;
    const std::size_t last = less.find_last_of("123456789");
    less[last] = char(less[last] - 1);
    if (less.find('.') == std::string::npos) less += '.';
    expect_as_strtof(less + std::string(300, '9'));
    if (HasFailure()) break;
  }
}

TEST(ParseInteger, ReadsAndRefuses) {
  EXPECT_EQ(parse_integer("-42 ").value, -42);
  EXPECT_EQ(parse_integer("+7").value, 7);
  EXPECT_EQ(parse_integer("9223372036854775807").value, 9223372036854775807LL);
  for (const char* text : {"", "-", "x", "9223372036854775808", "99999999999999999999", " 1"})
    EXPECT_EQ(parse_integer(text).end, nullptr) << text;
  const char* text = "12.5";
  EXPECT_EQ(parse_integer(text).end, text + 2);
}

void expect_round_trip(float value) {
  char text[max_float_text];
  char* end = format_float(text, value);
  ASSERT_LT(end, text + max_float_text);
  ASSERT_EQ(*end, '\0');
  EXPECT_EQ(bits_of(std::strtof(text, nullptr)), bits_of(value)) << text;
  EXPECT_EQ(bits_of(parse_decimal(text).value), bits_of(value)) << text;
}

TEST(FormatFloat, WritesShortTexts) {
  EXPECT_EQ(float_text(0.0f), "0");
  EXPECT_EQ(float_text(-0.0f), "-0");
  EXPECT_EQ(float_text(1.0f), "1");
  EXPECT_EQ(float_text(-0.5f), "-0.5");
  EXPECT_EQ(float_text(0.1f), "0.1");
  EXPECT_EQ(float_text(100.0f), "100");
  EXPECT_EQ(float_text(0.00001f), "0.00001");
  EXPECT_EQ(float_text(0.000001f), "1e-6");
  EXPECT_EQ(float_text(1e10f), "1e10");
  EXPECT_EQ(float_text(16777216.0f), "16777216");
  EXPECT_EQ(float_text(3.40282347e38f), "3.4028235e38");
  EXPECT_EQ(float_text(1.40129846e-45f), "1.4013e-45");
  EXPECT_EQ(float_text(NAN), "nan");
  EXPECT_EQ(float_text(-INFINITY), "-inf");
}

TEST(FormatFloat, RoundTripsPowersAndTheirNeighbours) {
  for (int exponent = -149; exponent < 128; ++exponent) {
    const float power = std::ldexp(1.0f, exponent);
    for (const float value : {power, std::nextafter(power, 0.0f), std::nextafter(power, INFINITY)})
      expect_round_trip(value);
  }
  for (int exponent = -45; exponent <= 38; ++exponent) {
    const float power = std::strtof(("1e" + std::to_string(exponent)).c_str(), nullptr);
    for (const float value : {power, std::nextafter(power, 0.0f), std::nextafter(power, INFINITY)})
      expect_round_trip(-value);
  }
}

TEST(FormatFloat, RoundTripsRandomBits_seed3) {
  std::mt19937 random(3);
  for (int i = 0; i < 300000 && !HasFailure(); ++i) {
    const std::uint32_t bits = random();
    if ((bits & 0x7f800000u) != 0x7f800000u) expect_round_trip(float_of(bits));
  }
}

}  // namespace decimal_test
}  // namespace tureen
