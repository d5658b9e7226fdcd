// Counter-based random numbers: each is a hash of its arguments and does not depend on the order of
// draws.
#pragma once

#include <cstdint>

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::kernels {

/// Every bit of the result depends on every bit of the argument (the finaliser of MurmurHash3).
TUREEN_HOST_DEVICE std::uint32_t mixed(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85ebca6bu;
  x ^= x >> 13;
  x *= 0xc2b2ae35u;
  return x ^ x >> 16;
}

/// The common key for all draws in one image of one step.
TUREEN_HOST_DEVICE std::uint32_t draw_key(std::uint64_t seed, std::uint32_t step,
                                          std::uint32_t view) {
  return mixed(std::uint32_t(seed) ^ mixed(std::uint32_t(seed >> 32) ^ mixed(step ^ mixed(view))));
}

/// Uniform on (0, 1], in steps of 2^-24. The test alpha >= u never accepts alpha 0 and always
/// accepts alpha 1.
TUREEN_HOST_DEVICE float uniform_draw(std::uint32_t key, std::uint32_t pixel, std::uint32_t face) {
  const std::uint32_t bits = mixed(mixed(pixel ^ key) + face * 0x9e3779b9u);
  return float((bits >> 8) + 1) * 0x1p-24f;
}

}  // namespace tureen::trainer::kernels
