// The checksum of PNG, zip and gzip. It detects damage; it does not authenticate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace tureen {

/// CRC-32 as in PNG's annex D, eight bytes at a time with a table for each (slicing: Kounavis and
/// Berry, 2008). A browser build has no zlib.
std::uint32_t crc32_of(std::span<const std::byte> bytes);

}  // namespace tureen
