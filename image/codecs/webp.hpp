// WebP, by libwebp, which the page lacks.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"
#include "image/image.hpp"

namespace tureen {

bool is_webp(std::span<const std::byte> bytes);

/// As decode_image() (image/png.hpp). Throws InputError; for an animation, too, and always in the
/// page.
Image8 decode_webp(std::span<const std::byte> bytes, const std::string& name, MemoryBudget budget);

/// Width and height by the header, which may be all of `bytes`. Throws as decode_webp().
glm::ivec2 webp_size(std::span<const std::byte> bytes, const std::string& name);
#ifndef __EMSCRIPTEN__
/// Lossless, with the colours of transparent pixels. At most 16,383 pixels a side. `effort`: 0..9;
/// higher values are smaller and take longer.
std::vector<std::byte> encode_webp(const Image8& image, int effort);
#endif

}  // namespace tureen
