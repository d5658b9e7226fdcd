// What must be known of a JPEG before stb_image decodes it: version 2.27 takes the number of codes
// of a Huffman table for granted and writes past its own where they are more than 256.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tureen {

/// The byte of the first Huffman table (marker DHT) that declares more than 256 codes; nothing
/// where none does, or where the bytes are no JPEG. Every place counts at which a decoder, however
/// it reads damaged data, could take one to begin.
std::optional<std::uint64_t> oversized_huffman_table(std::span<const std::byte> bytes);

}  // namespace tureen
