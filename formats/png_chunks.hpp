// What must be known of a PNG before stb_image decodes it: version 2.27 does not compare the
// checksums of chunks, and would show a damaged picture as one that is whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tureen {

/// The byte at which the first chunk begins that is not as it was written: its checksum is another
/// one. Chunks count that the picture is made of; others, as texts and times, may be damaged, which
/// other readers put up with, too. Nothing where there is none, or where the bytes are no PNG; a
/// chunk that is cut short is for the decoder to find.
std::optional<std::uint64_t> damaged_png_chunk(std::span<const std::byte> bytes);

}  // namespace tureen
