#include "formats/mesh/stray_content.hpp"

#include <algorithm>
#include <string_view>

#include "base/stray_text.hpp"

namespace tureen {

std::optional<StrayContent> stray_content(std::span<const std::byte> head) {
  if (const auto stray = stray_text(head)) return StrayContent{stray->reason, stray->hint};
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  const std::string_view words =
      text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (text.substr(0, 4) == "\x89PNG" || text.substr(0, 3) == "\xFF\xD8\xFF" ||
      (begins_with_any_case(text, "riff") &&
       text.substr(std::min<std::size_t>(8, text.size()), 4) == "WEBP"))
    return StrayContent{"an image, not a scene", ""};
  if (text.substr(0, 4) == "PK\x03\x04") {
    if (text.find("meta.json") != text.npos || text.find("lod-meta.json") != text.npos)
      return StrayContent{"a SOG file, which is not supported yet",
                          "splat-transform FILE.sog FILE.ply converts it"};
    return StrayContent{"a zip archive", "unzip it first"};
  }
  if (begins_with_any_case(words, "{") && text.find("\"means\"") != text.npos &&
      text.find("\"quats\"") != text.npos)
    return StrayContent{"the meta.json of a SOG folder, which is not supported yet",
                        "splat-transform meta.json FILE.ply converts it"};
  if (begins_with_any_case(words, "{") && text.find("\"geometricError\"") != text.npos)
    return StrayContent{"a tileset of 3D Tiles, which is not supported",
                        "convert its tiles one by one"};
  for (const char* start : {"b3dm", "i3dm", "pnts", "cmpt"})
    if (text.substr(0, 4) == start)
      return StrayContent{"a tile of 3D Tiles, which is not supported", ""};
  if (text.substr(0, 8) == "PXR-USDC" || begins_with_any_case(text, "#usda"))
    return StrayContent{"a USD file, which is not supported yet", "export it as PLY or GLB"};
  if (text.substr(0, 2) == "\x1F\x8B") return StrayContent{"compressed by gzip", "gunzip it first"};
  return std::nullopt;
}

}  // namespace tureen
