// Reads results from JSON; complements JsonView. Include it only in source files.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json/json_view.hpp"

namespace tureen::results {

/// A whole number from 0 to the largest int.
inline int integer(const JsonView& view) {
  return int(view.natural(std::uint64_t(std::numeric_limits<int>::max())));
}

/// A number from `low` to `high`.
inline double number_in(const JsonView& view, double low, double high) {
  const double value = view.number();
  if (!(value >= low && value <= high))
    view.fail(fmt::format("{} is not from {:g} to {:g}", value, low, high));
  return value;
}

/// A size or a count: at least 1.
inline int count_of(const JsonView& view) {
  const int count = integer(view);
  if (count == 0) view.fail("expected at least 1, not 0");
  return count;
}

/// Calls read() for every element.
template <class Read>
auto list(const JsonView& view, Read read) {
  std::vector<decltype(read(view))> result;
  for (std::size_t i = 0; i < view.size(); ++i) result.push_back(read(view.at(i)));
  return result;
}

/// A text of at most `longest` bytes. Reports repeat it in rows and at points in plots.
inline std::string text_within(const JsonView& view, std::size_t longest) {
  std::string text = view.text();
  if (text.size() > longest)
    view.fail(fmt::format("has {} bytes; the limit is {}", text.size(), longest));
  return text;
}

inline std::vector<std::string> texts(const JsonView& view) {
  return list(view, [](const JsonView& each) { return each.text(); });
}

/// "2026-11-21T15:04:05Z".
inline std::string date_of(const JsonView& view) {
  constexpr std::string_view form = "0000-00-00T00:00:00Z";
  const std::string& text = view.text();
  bool fits = text.size() == form.size();
  for (std::size_t i = 0; fits && i < form.size(); ++i)
    fits = form[i] == '0' ? text[i] >= '0' && text[i] <= '9' : text[i] == form[i];
  if (!fits) view.fail("expected a time of the form 2026-01-02T03:04:05Z");
  return text;
}

/// Fails if "format" is not `name`, with "this is " and `denial` (such as "not a result of tureen
/// bench"), or if "version" is not from 1 to `newest`.
inline void require_format(const JsonView& root, const std::string& name, int newest,
                           const std::string& denial) {
  const std::optional<JsonView> format = root.find("format");
  if (!format || !format->value().is_string() || format->text() != name)
    root.fail("this is " + denial);
  const int version = integer(root["version"]);
  if (version < 1) root["version"].fail(fmt::format("version {} does not exist", version));
  if (version > newest)
    root["version"].fail(fmt::format("version {} is newer than this program", version));
}

}  // namespace tureen::results
