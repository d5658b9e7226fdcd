// Texels of a soup that are decoded while their file is still arriving, strip by strip. The caller
// inflates them (image/deflated_png.hpp). For GLB files of ours with one layer and uncompressed
// texels; other files have no strips.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/glb/file_range.hpp"
#include "image/deflated_png.hpp"

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

struct DeflatedStrip {
  DeflatedPng low, high;
};

/// The images of a strip. `bytes`: those of strip.range(). Returns nullopt if they are damaged, of
/// different sizes, or have another number of rows than the texels need. Safe for untrusted bytes.
std::optional<DeflatedStrip> deflated_strip(const TexelStrip& strip,
                                            std::span<const std::byte> bytes);

/// Texels of the first strips of a file, for its reader.
class EarlyTexels {
 public:
  EarlyTexels() = default;
  /// `strips`: those of the file. Takes the memory for all texels.
  explicit EarlyTexels(std::vector<TexelStrip> strips);

  std::span<const TexelStrip> strips() const { return strips_; }
  /// Adds the next strip: its inflated images, whose rows have `width` pixels; their contents are
  /// overwritten. Returns false, and adds no further strip, if a row is missing or has an unknown
  /// filter.
  bool add(int width, std::span<std::byte> low, std::span<std::byte> high);

  /// Number of the first strips of a file that are decoded here; 0 if its strips are other ones.
  std::size_t decoded_of(std::span<const TexelStrip> strips) const;
  /// The texels of these strips, strip by strip, in the form of LatticeTexture::texels.
  std::vector<std::uint8_t> take() && { return std::move(texels_); }

 private:
  std::vector<TexelStrip> strips_;
  std::size_t added_ = 0;
  bool is_broken_ = false;
  std::vector<std::uint8_t> texels_;
};

}  // namespace tureen
