// What must be known of a PNG before stb_image decodes it: version 2.27 does not compare the
// checksums of chunks, and would show a damaged picture as one that is whole; of one that is cut
// short it does not say so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tureen {

struct PngDamage {
  std::uint64_t byte;  // at which the chunk begins
  const char* reason;
};

/// The first chunk that is not as it was written: its checksum is another one, or the bytes end
/// before it does. Chunks count that the picture is made of; others, as texts and times, may be
/// damaged, which other readers put up with, too, and so may the last one's checksum be missing.
/// Nothing where there is none, or where the bytes are no PNG.
std::optional<PngDamage> png_damage(std::span<const std::byte> bytes);

}  // namespace tureen
