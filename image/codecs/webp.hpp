// WebP, lossy and lossless, by libwebp.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <string>

#include "base/memory_budget.hpp"
#include "image/image.hpp"

namespace tureen {

bool is_webp(std::span<const std::byte> bytes);

/// As decode_image() (image/png.hpp). Throws InputError; for an animation, too, and in programs
/// without libwebp, such as the page's.
Image8 decode_webp(std::span<const std::byte> bytes, const std::string& name, MemoryBudget budget);

/// Width and height by the header, which may be all of `bytes`. Throws as decode_webp().
glm::ivec2 webp_size(std::span<const std::byte> bytes, const std::string& name);

}  // namespace tureen
