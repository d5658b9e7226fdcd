// What must be known of a JPEG before stb_image decodes it: version 2.27 takes the number of codes
// of a Huffman table for granted and writes past its own where they are more than 256.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tureen {

/// A Huffman table (marker DHT) that declares more than 256 codes.
struct OversizedTable {
  std::uint64_t byte;
  bool in_header;  // before the first scan, where every decoder reads it
};

/// The first such table; nothing where there is none, or where the bytes are no JPEG. Every place
/// counts at which a decoder, however it reads damaged data, could take one to begin: behind the
/// first scan also what is no part of the picture, as the film that telephones append to one.
std::optional<OversizedTable> oversized_huffman_table(std::span<const std::byte> bytes);

}  // namespace tureen
