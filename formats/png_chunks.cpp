#include "formats/png_chunks.hpp"

#include <array>
#include <cstring>

namespace tureen {

namespace {

/// The checksum of PNG's annex D, a byte at a time: a browser build has no zlib, and inflating
/// takes several times as long.
std::uint32_t crc32(std::span<const std::byte> bytes) {
  static constexpr auto table = [] {
    std::array<std::uint32_t, 256> sums{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      sums[i] = i;
      for (int bit = 0; bit < 8; ++bit) sums[i] = sums[i] >> 1 ^ (sums[i] & 1 ? 0xedb88320u : 0u);
    }
    return sums;
  }();
  std::uint32_t sum = ~0u;
  for (const std::byte byte : bytes)
    sum = table[(sum ^ std::to_integer<std::uint32_t>(byte)) & 0xff] ^ sum >> 8;
  return ~sum;
}

std::uint32_t big_endian(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes.first(4))
    value = value << 8 | std::to_integer<std::uint32_t>(byte);
  return value;
}

}  // namespace

std::optional<PngDamage> png_damage(std::span<const std::byte> bytes) {
  constexpr std::size_t signature = 8, head = 8, around = 12;  // length and type; and a checksum
  if (bytes.size() < signature || std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", signature) != 0)
    return std::nullopt;
  for (std::size_t at = signature;;) {
    const std::span<const std::byte> chunk = bytes.subspan(at);
    const auto is = [&](const char* type) { return std::memcmp(&chunk[4], type, 4) == 0; };
    const bool is_last = chunk.size() >= head && is("IEND");
    if (is_last && chunk.size() < around) return std::nullopt;
    if (chunk.size() < around || big_endian(chunk) > chunk.size() - around)
      return PngDamage{at, "it is cut short"};
    const std::size_t length = big_endian(chunk);
    // A capital begins what no picture can do without; stb reads tRNS, too.
    const bool is_critical = (std::to_integer<unsigned>(chunk[4]) & 0x20) == 0;
    if ((is_critical || is("tRNS")) &&
        crc32(chunk.subspan(4, 4 + length)) != big_endian(chunk.subspan(8 + length)))
      return PngDamage{at, "a chunk's checksum is not that of its bytes"};
    if (is_last) return std::nullopt;
    at += around + length;
  }
}

}  // namespace tureen
