// Places along the Morton curve: the bits of the cells of three axes take turns.
#pragma once

#include <cstdint>

namespace tureen {

/// Bits of an axis in a 64-bit code.
inline constexpr int morton_bits = 21;

/// The morton_bits low bits of `value`, each moved to three times its position.
constexpr std::uint64_t spread_bits(std::uint64_t value) {
  value &= (1u << morton_bits) - 1;
  value = (value | value << 32) & 0x001f00000000ffffu;
  value = (value | value << 16) & 0x001f0000ff0000ffu;
  value = (value | value << 8) & 0x100f00f00f00f00fu;
  value = (value | value << 4) & 0x10c30c30c30c30c3u;
  return (value | value << 2) & 0x1249249249249249u;
}

}  // namespace tureen
