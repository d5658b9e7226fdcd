// Numbers with fewer bits: of [0, 1] as bytes, value = byte / 255. The one place that rounds.
#pragma once

#include <algorithm>
#include <cstdint>

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

}  // namespace tureen
