#include "base/decimal_text.hpp"

#include <array>
#include <charconv>

namespace tureen {

namespace {

std::string formatted(double value, std::chars_format format, int precision) {
  std::array<char, 330> text;  // the largest double has 309 digits before the point
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, format, precision).ptr;
  return {text.data(), end};
}

}  // namespace

std::string short_decimal(double value, int digits) {
  return formatted(value, std::chars_format::general, digits);
}

std::string fixed_decimal(double value, int places) {
  return formatted(value, std::chars_format::fixed, places);
}

}  // namespace tureen
