// The chunks of PNG files, and a check of them before stb_image decodes a file. Version 2.27 does
// not compare the checksums of chunks and does not report truncation, so damaged images would pass
// as intact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tureen {

inline constexpr std::size_t png_signature_bytes = 8;
bool is_png(std::span<const std::byte> bytes);

/// A number in a PNG file: the first four bytes, big-endian.
std::uint32_t png_number(std::span<const std::byte> bytes);

struct PngChunk {
  const std::byte* type;  // four letters
  std::span<const std::byte> data;
  bool is(const char* name) const;
  /// The names of critical chunks begin with a capital letter. stb also reads tRNS.
  bool defines_image() const;
  /// With length, type and checksum.
  std::size_t file_bytes() const { return 12 + data.size(); }
};
/// The chunk at the beginning of `bytes`, which contain it.
PngChunk first_png_chunk(std::span<const std::byte> bytes);
/// Whether the chunk at the beginning of `bytes` is the file's last, IEND.
bool begins_with_last_chunk(std::span<const std::byte> bytes);

struct PngDamage {
  std::uint64_t byte;  // start of the chunk
  const char* reason;
};

/// The first damaged chunk: its checksum is wrong, or the bytes end inside it. Only chunks that
/// define the image are checked. Damage in others, such as texts and times, is accepted, as other
/// readers do; so is a missing checksum of the last chunk. Returns nullopt if all are intact or the
/// bytes are not a PNG.
std::optional<PngDamage> png_damage(std::span<const std::byte> bytes);

}  // namespace tureen
