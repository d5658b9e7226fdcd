// The checksum of PNG, zip and gzip. It detects damage; it does not authenticate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tureen {

/// CRC-32 as in PNG's annex D, one byte at a time. A browser build has no zlib, and decoding the
/// checked bytes takes several times as long.
std::uint32_t crc32_of(std::span<const std::byte> bytes);

}  // namespace tureen
