// The header before the coded texels of a compressed file, byte for byte. Internal to
// compressed_texels_*.cpp.
#pragma once

#include <array>
#include <cstdint>

#include "formats/tureen_glb/compressed_basis.hpp"

namespace tureen::compressed {

struct TexelHeader {
  std::uint8_t feature_step = 1;
  std::uint8_t alpha_step = 1;
  std::array<std::uint8_t, 2> zeros{};
  CompressedBasis basis;
};
static_assert(sizeof(TexelHeader) == 4 + 4 * 49);

}  // namespace tureen::compressed
