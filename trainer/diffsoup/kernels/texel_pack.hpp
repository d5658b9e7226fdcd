// The channels of one texel, in memory and in one register.
#pragma once

#include <cstring>

#include "trainer/common/kernels/host_device.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// The channels of one texel or pixel; never across two cache lines.
struct alignas(sizeof(float) * channels) Texel {
  float values[channels];
};
static_assert(sizeof(Texel) == sizeof(float) * channels);  // arrays are also read as floats

}  // namespace tureen::trainer

namespace tureen::trainer::kernels {

#if defined(__GNUC__) && !defined(__CUDACC__)

using TexelPack __attribute__((vector_size(sizeof(float) * channels))) = float;

TUREEN_HOST_DEVICE TexelPack load_texel(const float* values) {
  TexelPack result;
  std::memcpy(&result, values, sizeof result);
  return result;
}

TUREEN_HOST_DEVICE void store_texel(float* values, const TexelPack& texel) {
  std::memcpy(values, &texel, sizeof texel);
}

#endif

}  // namespace tureen::trainer::kernels
