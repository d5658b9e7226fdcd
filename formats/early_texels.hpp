// Texels of a soup that are decoded while their file is still arriving, strip by strip. A page thus
// decodes during the download and in two workers. For GLB files of ours with one layer and
// uncompressed texels; other files have no strips.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
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
  /// Eight bytes a texel.
  std::size_t texel_bytes() const { return 8 * texels; }
  /// From the first byte of `low` to the last of `high`.
  FileRange range() const { return {low.offset, high.end() - low.offset}; }
  bool operator==(const TexelStrip&) const = default;
};

/// The strips of the file's only layer, from its first bytes. None unless these contain the JSON
/// chunk and the header of the next one. Errors print `name` as the file. Throws InputError. Safe
/// for untrusted bytes.
std::vector<TexelStrip> texel_strips(std::span<const std::byte> prefix, const std::string& name);

/// The strip's texels. `bytes`: those of strip.range(). Throws InputError.
std::vector<std::uint8_t> decode_strip(const TexelStrip& strip, std::span<const std::byte> bytes,
                                       const std::string& name);

/// Texels of the first strips of a file, for its reader.
class EarlyTexels {
 public:
  EarlyTexels() = default;
  /// `strips`: those of the file. Takes the memory for all texels.
  explicit EarlyTexels(std::vector<TexelStrip> strips);

  std::span<const TexelStrip> strips() const { return strips_; }
  /// Adds the texels of strip `index` < strips().size(), as many as it has. Each strip once, in any
  /// order.
  void add(std::size_t index, std::vector<std::uint8_t> texels);

  /// Number of the first strips of a file that are decoded here; 0 if its strips are other ones.
  std::size_t decoded_of(std::span<const TexelStrip> strips) const;
  /// The texels of these strips, strip by strip, in the form of LatticeTexture::texels.
  std::vector<std::uint8_t> take() && { return std::move(texels_); }

 private:
  std::vector<TexelStrip> strips_;
  std::size_t added_ = 0;  // the first strips, whose texels are in texels_
  std::vector<std::uint8_t> texels_;
  std::map<std::size_t, std::vector<std::uint8_t>> waiting_;  // strips after these
};

}  // namespace tureen
