// Options that take a number between two others.
#pragma once

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <string>
#include <type_traits>

namespace tureen::cli {

/// Refuses whatever is not a number from `least` to `most`, both included.
template <class T>
auto between(T least, T most) {
  return [least, most](const std::string& text) -> std::string {
    T value{};
    // A comparison with what is not a number is false.
    if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return {};
    return fmt::format("'{}' is not a {}number from {} to {}", text,
                       std::is_integral_v<T> ? "whole " : "", least, most);
  };
}

}  // namespace tureen::cli
