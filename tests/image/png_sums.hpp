// Valid checksums for PNGs that were changed on purpose: readers reject other ones.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tureen::test {

/// Corrects the checksum of every chunk. It changes neither other formats nor a truncated chunk.
inline std::vector<std::byte> with_png_sums(std::vector<std::byte> png) {
  constexpr std::size_t signature = 8, around = 12;  // a chunk's length, type and checksum
  const bool is_png = !png.empty() && png[0] == std::byte{0x89};
  for (std::size_t at = signature; is_png && at + around <= png.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length = length << 8 | std::to_integer<std::size_t>(png[at + i]);
    if (length > png.size() - at - around) break;
    const auto sum = std::uint32_t(
        crc32(0, reinterpret_cast<const Bytef*>(&png[at + 4]), static_cast<uInt>(4 + length)));
    for (std::size_t i = 0; i < 4; ++i)
      png[at + 8 + length + i] = static_cast<std::byte>(sum >> (24 - 8 * i) & 0xff);
    at += around + length;
  }
  return png;
}

}  // namespace tureen::test
