// The row filters of PNG (specification, 3rd edition, section 9).
#pragma once

#include <cstdint>
#include <cstdlib>

namespace tureen {

/// The prediction by PNG's filters 0..4: zero, left, above, their mean, and Paeth's choice between
/// left, above and above left.
template <int filter>
std::uint8_t predicted(int left, int above, int above_left) {
  if constexpr (filter == 1) return std::uint8_t(left);
  if constexpr (filter == 2) return std::uint8_t(above);
  if constexpr (filter == 3) return std::uint8_t((left + above) / 2);
  if constexpr (filter == 4) {
    const int a = std::abs(above - above_left), b = std::abs(left - above_left);
    const int c = std::abs(left + above - 2 * above_left);
    return std::uint8_t(a <= b && a <= c ? left : b <= c ? above : above_left);
  }
  return 0;
}

}  // namespace tureen
