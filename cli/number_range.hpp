// Options that take a number between two others.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <string>
#include <system_error>
#include <type_traits>

namespace tureen::cli {

/// Refuses whatever is not a number from `least` to `most`, both included.
template <class T>
auto between(T least, T most) {
  return [least, most](const std::string& text) -> std::string {
    T value{};
    // CLI11 reads more than this, such as 0x10, which nobody means.
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    // A comparison with what is not a number is false.
    if (error == std::errc() && rest == end && value >= least && value <= most) return {};
    return fmt::format("'{}' is not a {}number from {} to {}", text,
                       std::is_integral_v<T> ? "whole " : "", least, most);
  };
}

}  // namespace tureen::cli
