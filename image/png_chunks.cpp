#include "image/png_chunks.hpp"

#include <cstring>

#include "base/crc32.hpp"

namespace tureen {

bool is_png(std::span<const std::byte> bytes) {
  return bytes.size() >= png_signature_bytes &&
         std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", png_signature_bytes) == 0;
}

std::uint32_t png_number(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes.first(4))
    value = value << 8 | std::to_integer<std::uint32_t>(byte);
  return value;
}

bool PngChunk::is(const char* name) const { return std::memcmp(type, name, 4) == 0; }

bool PngChunk::defines_image() const {
  return (std::to_integer<unsigned>(type[0]) & 0x20) == 0 || is("tRNS");
}

PngChunk first_png_chunk(std::span<const std::byte> bytes) {
  return {&bytes[4], bytes.subspan(8, png_number(bytes))};
}

bool begins_with_last_chunk(std::span<const std::byte> bytes) {
  return bytes.size() >= 8 && std::memcmp(&bytes[4], "IEND", 4) == 0;
}

std::optional<PngDamage> png_damage(std::span<const std::byte> bytes) {
  constexpr std::size_t around = 12;  // length, type and checksum
  if (!is_png(bytes)) return std::nullopt;
  for (std::size_t at = png_signature_bytes;;) {
    const std::span<const std::byte> rest = bytes.subspan(at);
    const bool is_last = begins_with_last_chunk(rest);
    if (is_last && rest.size() < around) return std::nullopt;
    if (rest.size() < around || png_number(rest) > rest.size() - around)
      return PngDamage{at, "it is truncated"};
    const PngChunk chunk = first_png_chunk(rest);
    const auto type_and_data = rest.subspan(4, 4 + chunk.data.size());
    if (chunk.defines_image() &&
        crc32_of(type_and_data) != png_number(rest.subspan(8 + chunk.data.size())))
      return PngDamage{at, "a chunk has a wrong checksum"};
    if (is_last) return std::nullopt;
    at += chunk.file_bytes();
  }
}

}  // namespace tureen
