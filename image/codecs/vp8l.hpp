// Lossless WebP (VP8L, RFC 9649), decoded without a library: programs and pages get the same bytes,
// and files that are tables of numbers, such as those of SOG, stay exact.
//
// Supported is all of VP8L in a RIFF container, also an extended one (VP8X). Lossy images,
// animations, and what else an extended container holds are not.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "base/memory_budget.hpp"
#include "image/image.hpp"

namespace tureen {

/// The VP8L stream of a WebP file. nullopt if the file is lossy, an animation, or no WebP. Throws
/// InputError, with `name` as the file, if the file ends within the stream.
std::optional<std::span<const std::byte>> vp8l_stream(std::span<const std::byte> webp,
                                                      const std::string& name);

/// The image, with the values of all four channels as stored. Throws InputError with the reason if
/// the stream is damaged, ends early, or exceeds the budget. Time and memory are bounded by the
/// number of pixels in the header plus the size of the stream.
Image8 decode_vp8l(std::span<const std::byte> stream, const std::string& name, MemoryBudget budget);

}  // namespace tureen
