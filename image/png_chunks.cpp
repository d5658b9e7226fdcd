#include "image/png_chunks.hpp"

#include <cstring>

#include "base/crc32.hpp"

namespace tureen {

namespace {

std::uint32_t big_endian(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes.first(4))
    value = value << 8 | std::to_integer<std::uint32_t>(byte);
  return value;
}

}  // namespace

std::optional<PngDamage> png_damage(std::span<const std::byte> bytes) {
  // head: length and type; around: length, type and checksum.
  constexpr std::size_t signature = 8, head = 8, around = 12;
  if (bytes.size() < signature || std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", signature) != 0)
    return std::nullopt;
  for (std::size_t at = signature;;) {
    const std::span<const std::byte> chunk = bytes.subspan(at);
    const auto is = [&](const char* type) { return std::memcmp(&chunk[4], type, 4) == 0; };
    const bool is_last = chunk.size() >= head && is("IEND");
    if (is_last && chunk.size() < around) return std::nullopt;
    if (chunk.size() < around || big_endian(chunk) > chunk.size() - around)
      return PngDamage{at, "it is truncated"};
    const std::size_t length = big_endian(chunk);
    // The names of critical chunks begin with a capital letter. stb also reads tRNS.
    const bool is_critical = (std::to_integer<unsigned>(chunk[4]) & 0x20) == 0;
    if ((is_critical || is("tRNS")) &&
        crc32_of(chunk.subspan(4, 4 + length)) != big_endian(chunk.subspan(8 + length)))
      return PngDamage{at, "a chunk has a wrong checksum"};
    if (is_last) return std::nullopt;
    at += around + length;
  }
}

}  // namespace tureen
