// Base64 (RFC 4648, section 4), for bytes within pages.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tureen::cli {

/// Padded to a multiple of four digits. Pieces of whole triples of bytes, put side by side, give
/// what all of them at once would.
std::string base64(std::span<const std::byte> bytes);

}  // namespace tureen::cli
