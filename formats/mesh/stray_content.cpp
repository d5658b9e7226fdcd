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
  if (text.substr(0, 4) == "\x89PNG" || text.substr(0, 3) == "\xFF\xD8\xFF" ||
      (begins_with(text, "riff") &&
       text.substr(std::min<std::size_t>(8, text.size()), 4) == "WEBP"))
    return StrayContent{"an image, not a scene", ""};
  if (text.substr(0, 4) == "PK\x03\x04") {
    if (text.find("meta.json") != text.npos || text.find("lod-meta.json") != text.npos)
      return StrayContent{"a SOG file, which is not supported yet",
                          "splat-transform FILE.sog FILE.ply converts it"};
    return StrayContent{"a zip archive", "unzip it first"};
  }
  if (begins_with(words, "{") && text.find("\"means\"") != text.npos &&
      text.find("\"quats\"") != text.npos)
    return StrayContent{"the meta.json of a SOG folder, which is not supported yet",
                        "splat-transform meta.json FILE.ply converts it"};
  if (begins_with(words, "{") && text.find("\"geometricError\"") != text.npos)
    return StrayContent{"a tileset of 3D Tiles, which is not supported",
                        "convert its tiles one by one"};
  for (const char* start : {"b3dm", "i3dm", "pnts", "cmpt"})
    if (text.substr(0, 4) == start)
      return StrayContent{"a tile of 3D Tiles, which is not supported", ""};
  if (text.substr(0, 8) == "PXR-USDC" || begins_with(text, "#usda"))
    return StrayContent{"a USD file, which is not supported yet", "export it as PLY or GLB"};
  if (text.substr(0, 2) == "\x1F\x8B") return StrayContent{"compressed by gzip", "gunzip it first"};
  return std::nullopt;
}

}  // namespace tureen
