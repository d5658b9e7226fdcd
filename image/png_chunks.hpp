// A check of PNG files before stb_image decodes them. Version 2.27 does not compare the checksums
// of chunks and does not report truncation, so damaged images would pass as intact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tureen {

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
