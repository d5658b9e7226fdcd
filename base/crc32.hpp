// The checksum of PNG, zip and gzip: it tells damage, not intent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tureen {

/// CRC-32 as in PNG's annex D, a byte at a time: a browser build has no zlib, and what is checked
/// takes several times as long to decode.
std::uint32_t crc32_of(std::span<const std::byte> bytes);

}  // namespace tureen
