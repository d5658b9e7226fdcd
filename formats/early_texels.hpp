// Texels of a soup that are decoded while their file is still arriving, strip by strip. A page thus
// decodes during the download, and in two workers. For GLB files of ours with one layer and
// uncompressed texels; other files have no strips.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/file_range.hpp"

namespace tureen {

/// Texels in two images (docs/format.md): channels 0 to 3, and 4 to 7.
struct TexelStrip {
  FileRange low, high;
  std::size_t texels = 0;
  /// From the first byte of `low` to the last of `high`.
  FileRange range() const { return {low.offset, high.end() - low.offset}; }
  bool operator==(const TexelStrip&) const = default;
};

/// The strips of the file's only layer, from its first bytes. None unless these contain the JSON
/// chunk and the header of the next one. Errors print `name` as the file. Throws InputError. Safe
/// for untrusted bytes.
std::vector<TexelStrip> texel_strips(std::span<const std::byte> prefix, const std::string& name);

/// Appends the strip's texels, eight bytes each, unless it throws. `bytes`: those of strip.range().
/// Throws InputError.
void decode_strip(const TexelStrip& strip, std::span<const std::byte> bytes,
                  const std::string& name, std::vector<std::uint8_t>& texels);

/// Texels of the first strips of a file, for its reader.
struct EarlyTexels {
  std::vector<TexelStrip> strips;
  std::vector<std::uint8_t> texels;  // of all these strips

  /// Whether these are the first of `all` strips of a file.
  bool begin(std::span<const TexelStrip> all) const;
};

}  // namespace tureen
