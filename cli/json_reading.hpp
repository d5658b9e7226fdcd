// Reading results from JSON: what JsonView leaves to those who read lists of them. Include it in
// sources only.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "formats/json_view.hpp"

namespace tureen::cli {

/// A whole number that an int holds.
inline int integer(const JsonView& view) {
  return int(view.natural(std::uint64_t(std::numeric_limits<int>::max())));
}

inline bool boolean(const JsonView& view) {
  if (!view.value().is_boolean()) view.fail("expected true or false");
  return view.value().get<bool>();
}

/// read() of every element.
template <class Read>
auto list(const JsonView& view, Read read) {
  std::vector<decltype(read(view))> result;
  for (std::size_t i = 0; i < view.size(); ++i) result.push_back(read(view.at(i)));
  return result;
}

inline std::vector<std::string> texts(const JsonView& view) {
  return list(view, [](const JsonView& each) { return each.text(); });
}

}  // namespace tureen::cli
