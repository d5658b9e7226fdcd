// Numbers with fewer bits: of [0, 1] as bytes, value = byte / 255, or as four bits, value = q / 15;
// halves; signed bytes. The one place that rounds.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/packing.hpp>

namespace tureen {

/// Rounds half up; clamps, NaN becomes 0. In double, where 255 value + 1/2 is exact for floats:
/// the byte's value is never further than 1/2/255 from a value in [0, 1].
inline std::uint8_t quantised_unit(float value) {
  if (!(value > 0.0f)) return 0;  // NaN too
  return static_cast<std::uint8_t>(255.0 * double(std::min(value, 1.0f)) + 0.5);
}

/// The same for an alpha that is tested against 1/2 (alpha_threshold): a byte keeps the side of
/// its value. 1/2 itself becomes 128, and nothing below it does.
inline std::uint8_t quantised_alpha(float alpha) {
  const std::uint8_t byte = quantised_unit(alpha);
  return alpha >= 0.5f ? std::max<std::uint8_t>(byte, 128) : std::min<std::uint8_t>(byte, 127);
}

/// In four bits: the nearest of 0 .. 15, and for an alpha the nearest on its side of 1/2.
inline std::uint8_t quantised_unit4(float value) {
  if (!(value > 0.0f)) return 0;
  return static_cast<std::uint8_t>(15.0 * double(std::min(value, 1.0f)) + 0.5);
}
inline std::uint8_t quantised_alpha4(float alpha) {
  const std::uint8_t q = quantised_unit4(alpha);
  return alpha >= 0.5f ? std::max<std::uint8_t>(q, 8) : std::min<std::uint8_t>(q, 7);
}

/// A number of [-scale, scale] as value = byte * scale / 127; clamps, NaN becomes 0.
inline std::int8_t quantised_signed(float value, float scale) {
  const float steps = std::round(value / scale * 127.0f);
  if (!(steps == steps)) return 0;
  return static_cast<std::int8_t>(std::clamp(steps, -127.0f, 127.0f));
}

/// IEEE halves, to nearest.
inline std::uint16_t half_from_float(float value) { return glm::packHalf1x16(value); }
inline float float_from_half(std::uint16_t half) { return glm::unpackHalf1x16(half); }
/// The same for an alpha, which keeps its side of 1/2: 0x37ff is the half next below.
inline std::uint16_t half_alpha(float alpha) {
  const std::uint16_t half = half_from_float(alpha);
  return alpha < 0.5f && float_from_half(half) >= 0.5f ? std::uint16_t(0x37ff) : half;
}

}  // namespace tureen
