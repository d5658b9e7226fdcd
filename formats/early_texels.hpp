// Texels of a soup that are decoded while their file is still arriving, strip by strip. A page thus
// decodes during the download. For GLB files of ours with one layer and uncompressed texels; other
// files have no strips.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/file_range.hpp"

namespace tureen {

/// Texels in two images (docs/format.md): channels 0 to 3, and 4 to 7.
struct TexelStrip {
  FileRange low, high;
  std::size_t texels = 0;
  bool operator==(const TexelStrip&) const = default;
};

class EarlyTexels {
 public:
  /// Without strips.
  EarlyTexels() = default;
  /// `prefix`: the first bytes of the file. There are no strips unless they contain the JSON chunk
  /// and the header of the next one. Errors print `name` as the file. Throws InputError. Safe for
  /// untrusted bytes.
  EarlyTexels(std::span<const std::byte> prefix, std::string name);

  /// The bytes of the next strip; nullopt if there is none.
  std::optional<FileRange> next() const;
  /// Decodes the next strip from its bytes. Throws InputError; then there is no next strip.
  void add(std::span<const std::byte> bytes);

  /// Number of the first of these strips that are decoded here; 0 if they are not the same strips.
  std::size_t decoded_of(std::span<const TexelStrip> strips) const;
  /// The decoded texels, eight bytes each.
  std::vector<std::uint8_t> take_texels() && { return std::move(texels_); }

 private:
  std::string name_;
  std::vector<TexelStrip> strips_;
  std::size_t decoded_ = 0;
  bool failed_ = false;
  std::vector<std::uint8_t> texels_;
};

}  // namespace tureen
