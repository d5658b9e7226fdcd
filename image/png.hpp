// PNG as plain data: no colour management, no gamma, no premultiplication, rows top to bottom.
// These files also store lattice texels, so every byte must be exact.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "image/image.hpp"

namespace tureen {

/// Largest width and height; larger images are rejected before any allocation.
inline constexpr int max_image_side = 65536;
/// Largest number of pixels; larger images are rejected. 2^28 RGBA pixels are 1 GiB.
inline constexpr std::size_t max_image_pixels = std::size_t(1) << 28;

/// Decodes a PNG, a JPEG or a WebP image to RGBA. Missing alpha becomes 255; 16 bits become 8 (the
/// high byte). Throws InputError, with `name` as the file, if decoding fails, exceeds the budget,
/// or needs more memory than a valid image of this size can need. Charges the image's memory to the
/// budget.
Image8 decode_image(std::span<const std::byte> bytes, const std::string& name,
                    MemoryBudget budget = MemoryBudget());

/// Width and height in pixels. `bytes` may be only the beginning of the file, with its header.
/// Throws as decode_image().
glm::ivec2 image_size(std::span<const std::byte> bytes, const std::string& name);

/// decode_image of all bytes of `input` from its position on.
Image8 read_image(Input& input);

/// RGBA8, lossless.
std::vector<std::byte> encode_png(const Image8& image);

}  // namespace tureen
