// The functions between stored and used values of splats (3DGS, https://arxiv.org/abs/2308.04079):
// opacity = sigmoid(stored), scale = exp(stored). In double, so that only the result is rounded.
#pragma once

#include <cmath>

namespace tureen {

/// 0..1; exactly 0 and 1 for -infinity and +infinity.
inline double sigmoid(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

/// Stored values of 0 and 1, where the inverses are infinite. Many programs reject infinities.
/// exp(-104) = 6.8e-46 is below half the smallest float (7.0e-46) and therefore rounds to 0.
/// sigmoid(20) = 1 - 2.1e-9 rounds to 1: the float below 1 is 1 - 6.0e-8.
inline constexpr double stored_zero = -104;
inline constexpr double stored_one = 20;

/// The inverse of exp, rounded to float; `value` >= 0. The rounding changes exp of it by a relative
/// error of at most 6e-8 |log(value)|.
inline float stored_scale(double value) {
  return static_cast<float>(value > 0 ? std::log(value) : stored_zero);
}

/// The inverse of sigmoid, rounded to float; `opacity` in 0..1. The relative error is that of
/// stored_scale.
inline float stored_opacity(double opacity) {
  if (opacity <= 0) return static_cast<float>(stored_zero);
  if (opacity >= 1) return static_cast<float>(stored_one);
  return static_cast<float>(std::log(opacity) - std::log1p(-opacity));
}

}  // namespace tureen
