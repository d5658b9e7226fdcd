// PNG as plain data: no colour management, no gamma, no premultiplication, rows top to bottom.
// Texels of a lattice travel in these files, so every byte counts.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "image/image.hpp"

namespace tureen {

/// Width and height are refused above this before anything is allocated.
inline constexpr int max_image_side = 65536;
/// Pixels of one image are refused above this: 2^28 RGBA pixels are 1 GiB.
inline constexpr std::size_t max_image_pixels = std::size_t(1) << 28;

/// Decodes a PNG or a JPEG to RGBA; missing alpha becomes 255, 16 bits become 8 (the high byte).
/// `name` stands for the file in the InputError thrown for anything undecodable, and for what takes
/// more memory than the budget has left, or while it is decoded more than pictures of its size do.
/// Of the budget it keeps what the image takes.
Image8 decode_image(std::span<const std::byte> bytes, const std::string& name,
                    MemoryBudget budget = MemoryBudget());

/// decode_image of everything that `input` holds from its position on.
Image8 read_image(Input& input);

/// RGBA8, lossless.
std::vector<std::byte> encode_png(const Image8& image);

}  // namespace tureen
