// The gradient of opacity: the score function of stochastic masking.
//
// A fragment is accepted with probability alpha; the nearest accepted fragment is visible. With l
// the loss of the pixel, dE[l]/dalpha_k = E[l s_k]. s_k = 1/alpha_k for the winner,
// -1/(1 - alpha_k) for fragments in front of it, and 0 behind it (DiffSoup, arXiv 2603.27151,
// equation 6). E[s_k] = 0, so any baseline that does not depend on the draw may be subtracted
// from l.
#pragma once

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::kernels {

enum class FragmentRole { winner, in_front };

/// The derivative of the draw's log-probability by one texel's logit. The fragment's alpha is
/// sum_j weight_j alpha_j over three texels; this texel is one of them. The absolute value is at
/// most 1, because 1 - alpha >= weight (1 - alpha_j) and alpha >= weight alpha_j. The smallest
/// denominator, 1e-30, applies if alpha_j is exactly 0 or 1; the numerator is then 0.
template <class Real>
TUREEN_HOST_DEVICE Real logit_score(FragmentRole role, Real alpha, Real weight, Real alpha_j) {
  const Real numerator = weight * alpha_j * (1 - alpha_j);
  const Real probability = role == FragmentRole::winner ? alpha : 1 - alpha;
  const Real ratio = numerator / (probability > Real(1e-30) ? probability : Real(1e-30));
  // Rounding errors in alpha and 1 - alpha may push the ratio above its bound. NaN stays NaN; the
  // optimiser skips it.
  const Real bounded = ratio > 1 ? Real(1) : ratio;
  return role == FragmentRole::winner ? bounded : -bounded;
}

}  // namespace tureen::trainer::kernels
