#include "formats/mesh/stray_content.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace tureen {

namespace {

bool begins_with(std::string_view text, std::string_view lower_case) {
  return text.size() >= lower_case.size() &&
         std::equal(lower_case.begin(), lower_case.end(), text.begin(), [](char expected, char c) {
           return expected == static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
         });
}

}  // namespace

std::optional<StrayContent> stray_content(std::span<const std::byte> head) {
  if (head.empty()) return StrayContent{"the file is empty", ""};
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (begins_with(text, "version https://git-lfs"))
    return StrayContent{"a Git LFS pointer instead of the file",
                        "git lfs pull fetches the file itself"};
  const std::size_t first =
      text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // and a UTF-8 byte order mark
  const std::string_view words = first == text.npos ? std::string_view() : text.substr(first);
  for (const char* start : {"<!doctype html", "<html", "<?xml"})
    if (begins_with(words, start))
      return StrayContent{
          "a web page, not a scene: most likely the answer of a server instead of the file", ""};
  if (text.substr(0, 4) == "\x89PNG" || text.substr(0, 3) == "\xFF\xD8\xFF")
    return StrayContent{"an image, not a scene", ""};
  if (text.substr(0, 2) == "\x1F\x8B") return StrayContent{"compressed by gzip", "gunzip it first"};
  return std::nullopt;
}

}  // namespace tureen
