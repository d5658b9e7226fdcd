#include "base/decimal_text.hpp"

#include <array>
#include <cstdio>

namespace tureen {

namespace {

// std::to_chars is not an option: browser toolchains support it only for integers.
std::string formatted(const char* format, int digits, double value) {
  std::array<char, 330> text;  // the largest double has 309 digits before the point
  const int size = std::snprintf(text.data(), text.size(), format, digits, value);
  std::string result(text.data(), std::size_t(size));
  // A locale's decimal point may have several characters, but never a character of a number.
  constexpr const char* of_numbers = "0123456789+-einfa";
  const std::size_t point = result.find_first_not_of(of_numbers);
  if (point != std::string::npos) {
    const std::size_t end = result.find_first_of(of_numbers, point);
    result.replace(point, end - point, ".");
  }
  return result;
}

}  // namespace

std::string short_decimal(double value, int digits) { return formatted("%.*g", digits, value); }

std::string fixed_decimal(double value, int places) { return formatted("%.*f", places, value); }

std::string counted(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

std::string counted(std::uint64_t number, std::string_view noun) {
  return counted(number) + " " + std::string(noun) + (number == 1 ? "" : "s");
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(seconds + 0.5);
  const auto text = [](long long number, const char* unit) {
    return std::to_string(number) + " " + unit;
  };
  if (whole < 60) return text(whole, "s");
  if (whole < 3600) return text(whole / 60, "min ") + text(whole % 60, "s");
  return text(whole / 3600, "h ") + text(whole / 60 % 60, "min");
}

}  // namespace tureen
