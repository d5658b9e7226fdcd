// A check of JPEG files before stb_image decodes them. Version 2.27 does not check the number of
// codes in a Huffman table and writes out of bounds beyond 256.
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

/// The first such table; nullopt if there is none or the bytes are not a JPEG. Checks every
/// position where a decoder may start reading a table in damaged data. After the first scan this
/// includes data outside the image, such as the video that phones append.
std::optional<OversizedTable> oversized_huffman_table(std::span<const std::byte> bytes);

}  // namespace tureen
