#include "runtime/texel_encoding.hpp"

#include <cassert>
#include <cstdint>
#include <cstring>

#include "soup/quantise.hpp"

namespace tureen {

TexelFormat rgba_format(int bits) {
  switch (bits) {
    case 4:
      return texel_formats::rgba4;
    case 8:
      return texel_formats::rgba8;
    case 16:
      return texel_formats::rgba16f;
    default:
      assert(bits == 32);
      return texel_formats::rgba32f;
  }
}

void encode_texel(const std::array<float, 4>& values, int bits, Alphas alphas, std::byte* out) {
  const bool alpha = alphas == Alphas::all;
  if (bits == 32) {
    std::memcpy(out, values.data(), sizeof values);
  } else if (bits == 16) {
    std::array<std::uint16_t, 4> halves;
    for (std::size_t c = 0; c < 4; ++c)
      halves[c] = alpha ? half_alpha(values[c]) : half_from_float(values[c]);
    std::memcpy(out, halves.data(), sizeof halves);
  } else if (bits == 8) {
    for (std::size_t c = 0; c < 4; ++c)
      out[c] = std::byte(alpha ? quantised_alpha(values[c]) : quantised_unit(values[c]));
  } else {
    // The first component lies in the highest bits.
    std::uint16_t packed = 0;
    for (const float value : values)
      packed =
          std::uint16_t(packed << 4 | (alpha ? quantised_alpha4(value) : quantised_unit4(value)));
    std::memcpy(out, &packed, sizeof packed);
  }
}

}  // namespace tureen
