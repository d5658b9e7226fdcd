#include "base/stray_text.hpp"

#include <algorithm>
#include <cctype>

namespace tureen {

bool begins_with_any_case(std::string_view text, std::string_view lower_case) {
  return text.size() >= lower_case.size() &&
         std::equal(lower_case.begin(), lower_case.end(), text.begin(), [](char expected, char c) {
           return expected == static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
         });
}

std::optional<StrayText> stray_text(std::span<const std::byte> head) {
  if (head.empty()) return StrayText{"the file is empty", ""};
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (begins_with_any_case(text, "version https://git-lfs"))
    return StrayText{"a Git LFS pointer instead of the file",
                     "git lfs pull fetches the file itself"};
  const std::size_t first =
      text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // and a UTF-8 byte order mark
  const std::string_view words = first == text.npos ? std::string_view() : text.substr(first);
  for (const char* start : {"<!doctype html", "<html", "<?xml"})
    if (begins_with_any_case(words, start))
      return StrayText{"a web page: most likely the answer of a server instead of the file", ""};
  return std::nullopt;
}

}  // namespace tureen
