// Little-endian numbers in bytes, on any machine.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tureen {

/// The unsigned number in `size` bytes, 1..8, from `at` on.
inline std::uint64_t little_number(std::span<const std::byte> bytes, std::size_t at,
                                   std::size_t size) {
  assert(size <= 8 && at + size <= bytes.size());
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;)
    value = value << 8 | std::to_integer<std::uint64_t>(bytes[at + i]);
  return value;
}

inline float little_float(std::span<const std::byte> bytes, std::size_t at) {
  const auto bits = static_cast<std::uint32_t>(little_number(bytes, at, 4));
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace tureen
