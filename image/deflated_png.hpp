// PNG files that the caller decompresses: in a browser, its decompressor is several times as fast
// as stb_image in WebAssembly. deflated_png() finds the compressed pieces, and unfilter() makes
// pixels of the inflated stream. For images as encode_png() writes them; decode_image() reads all.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tureen {

/// Bytes of a row in the inflated stream: the number of its filter, and its filtered pixels.
inline std::size_t png_row_bytes(int width) { return 1 + 4 * std::size_t(width); }

/// An RGBA image with 8 bits a channel, not interlaced.
struct DeflatedPng {
  int width = 0, height = 0;
  std::vector<std::span<const std::byte>> pieces;  // of the file; together one zlib stream
  std::size_t inflated_bytes() const { return png_row_bytes(width) * std::size_t(height); }
};

/// Checks the chunks of a file. Returns nullopt if it is damaged or another kind of image. Safe for
/// untrusted bytes.
std::optional<DeflatedPng> deflated_png(std::span<const std::byte> file);

/// Reverses the filters of an inflated stream's rows in place (PNG specification, 3rd edition,
/// section 9). `stream`: whole rows. Returns false for an unknown filter.
bool unfilter(std::span<std::byte> stream, int width);

}  // namespace tureen
