// Compression in the zlib format: DEFLATE (RFC 1951) between a zlib header and an Adler-32
// (RFC 1950). Made for filtered rows of images: one quick search for repeats, and Huffman codes
// fitted to every block, which is where such data gains most. It compresses only: PNG is read by
// stb.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tureen {

/// Any bytes, none too. The result is never more than 0.1 % + 20 bytes longer. At most 2^31 bytes
/// (a caller's bug otherwise).
std::vector<std::byte> zlib_compress(std::span<const std::byte> bytes);

}  // namespace tureen
