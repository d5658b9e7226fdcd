// Base64 (RFC 4648, section 4), for bytes inside pages.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tureen::cli {

/// Padded to a multiple of four digits. Encoded pieces of 3 n bytes may be concatenated: the result
/// equals the encoding of all bytes at once.
std::string base64(std::span<const std::byte> bytes);

}  // namespace tureen::cli
