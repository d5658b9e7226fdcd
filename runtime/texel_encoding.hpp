// Four channels of a texel as a device stores them with 32, 16, 8 or 4 bits each.
#pragma once

#include <array>
#include <cstddef>

#include "runtime/texel_store.hpp"

namespace tureen {

/// RGBA32F, RGBA16F, RGBA8 or RGBA4.
TexelFormat rgba_format(int bits);

/// Which of the four are alphas, that must keep their side of alpha_threshold.
enum class Alphas { none, all };

/// Writes rgba_format(bits).bytes. Values are of [0, 1]; with fewer than 16 bits they are clamped.
void encode_texel(const std::array<float, 4>& values, int bits, Alphas alphas, std::byte* out);

}  // namespace tureen
