// Quantisation from [0, 1] to bytes, value = byte / 255. All rounding is here.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tureen {

/// Rounds half up; clamps; NaN becomes 0. Computed in double, where 255 value + 1/2 is exact for
/// floats: the error is at most 1/2/255 for values in [0, 1].
inline std::uint8_t quantised_unit(float value) {
  if (!(value > 0.0f)) return 0;  // NaN too
  return static_cast<std::uint8_t>(255.0 * double(std::min(value, 1.0f)) + 0.5);
}

/// The same for an alpha that is tested against 1/2 (alpha_threshold). The byte stays on the same
/// side of the threshold: 1/2 becomes 128, smaller values at most 127.
inline std::uint8_t quantised_alpha(float alpha) {
  const std::uint8_t byte = quantised_unit(alpha);
  return alpha >= 0.5f ? std::max<std::uint8_t>(byte, 128) : std::min<std::uint8_t>(byte, 127);
}

}  // namespace tureen
