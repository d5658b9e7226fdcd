// Functions of one number for kernels. The number is a float, a double, or a pack of floats
// (trainer/common/kernels/pack.hpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "trainer/common/kernels/host_device.hpp"
#include "trainer/common/kernels/pack.hpp"

namespace tureen::trainer::kernels {

namespace exponential_constants {
inline constexpr float inverse_ln2 = 1.44269504f;
inline constexpr float shifter = 12582912.0f;  // 1.5 * 2^23: adding it rounds to an integer
// ln 2 in two parts; k * ln2_high is exact.
inline constexpr float ln2_high = 0.693359375f, ln2_low = -2.12194440e-4f;
}  // namespace exponential_constants

/// e^r for |r| <= ln2 / 2: Taylor polynomial of degree 7, remainder 0.347^8 / 8! = 5e-9.
template <class Real>
TUREEN_HOST_DEVICE Real exponential_polynomial(const Real& r) {
  Real p = r * (1.0f / 5040) + 1.0f / 720;
  p = p * r + 1.0f / 120;
  p = p * r + 1.0f / 24;
  p = p * r + 1.0f / 6;
  p = p * r + 0.5f;
  p = p * r + 1.0f;
  return p * r + 1.0f;
}

/// e^x to 2 ulp without a library call: 2^k from the exponent's bits, times a polynomial. Arguments
/// are clamped to [-87, 87], so the result and 2^k stay normal floats.
TUREEN_HOST_DEVICE float exponential(float x) {
  x = x < -87.0f ? -87.0f : x;
  x = x > 87.0f ? 87.0f : x;
  const float shifted = x * exponential_constants::inverse_ln2 + exponential_constants::shifter;
  const float k = shifted - exponential_constants::shifter;
  const float r = (x - k * exponential_constants::ln2_high) - k * exponential_constants::ln2_low;
  std::int32_t bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  // The low bits of `shifted` hold the integer k; the shift drops the upper bits. The type is
  // unsigned because a large k shifts into the sign bit.
  const std::uint32_t exponent = (std::uint32_t(bits) + 127u) << 23;
  float scale;
  std::memcpy(&scale, &exponent, sizeof scale);
  return exponential_polynomial(r) * scale;
}

TUREEN_HOST_DEVICE double exponential(double x) { return std::exp(x); }

#if defined(__GNUC__) && !defined(__CUDACC__)
/// The same arithmetic as exponential(float), lane by lane.
TUREEN_HOST_DEVICE Pack exponential(const Pack& value) {
  Pack x = value < -87.0f ? Pack{} - 87.0f : value;
  x = x > 87.0f ? Pack{} + 87.0f : x;
  const Pack shifted = x * exponential_constants::inverse_ln2 + exponential_constants::shifter;
  const Pack k = shifted - exponential_constants::shifter;
  const Pack r = (x - k * exponential_constants::ln2_high) - k * exponential_constants::ln2_low;
  const IntPack bits = ((IntPack)shifted + 127) << 23;
  return exponential_polynomial(r) * (Pack)bits;
}

#endif

/// The nearest number of half precision (11 significant bits, up to 65504). Numbers below 2^-14,
/// the smallest normal one, become 0.
TUREEN_HOST_DEVICE float rounded_to_half(float x) {
  if (!(std::fabs(x) >= 0x1p-14f)) return x != x ? x : 0.0f;
  if (std::fabs(x) > 65504.0f) return x > 0 ? 65504.0f : -65504.0f;
  const float c = x * 8193.0f;  // 2^13 + 1: Dekker's split keeps the upper 24 - 13 bits
  return c - (c - x);
}

/// 1 / (1 + e^-x); saturates without overflow on both sides.
template <class Real>
TUREEN_HOST_DEVICE Real sigmoid(const Real& x) {
  return 1.0f / (1.0f + exponential(-x));
}

template <class Real>
TUREEN_HOST_DEVICE Real positive_part(const Real& x) {
  return x > Real{} ? x : Real{};
}

}  // namespace tureen::trainer::kernels
