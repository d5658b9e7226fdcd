// Angles in radians.
#pragma once

#include <numbers>

namespace tureen {

inline constexpr double full_turn = 2 * std::numbers::pi;
inline constexpr double degree = std::numbers::pi / 180;

}  // namespace tureen
