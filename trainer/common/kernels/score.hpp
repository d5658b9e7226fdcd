// How opacity learns: the score function of stochastic masking.
//
// A fragment is accepted with probability alpha; the nearest accepted one shows. With l the loss
// of the pixel, dE[l]/dalpha_k = E[l s_k], s_k = 1/alpha_k for the winner, -1/(1 - alpha_k) for
// those in front of it, 0 behind (DiffSoup, arXiv 2603.27151, equation 6). Since E[s_k] = 0 any
// baseline that does not depend on the draw may be taken from l.
#pragma once

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::kernels {

enum class FragmentRole { winner, in_front };

/// The derivative of the log-probability of what was drawn by one texel's logit. The fragment's
/// alpha is sum_j weight_j alpha_j over three texels, of which this is one. Bounded by 1: since
/// 1 - alpha >= weight (1 - alpha_j) and alpha >= weight alpha_j, so nothing is clamped that
/// matters; the tiny denominator serves an alpha_j that is 0 or 1 to the last bit, where the
/// numerator is 0.
template <class Real>
TUREEN_HOST_DEVICE Real logit_score(FragmentRole role, Real alpha, Real weight, Real alpha_j) {
  const Real numerator = weight * alpha_j * (1 - alpha_j);
  const Real probability = role == FragmentRole::winner ? alpha : 1 - alpha;
  const Real ratio = numerator / (probability > Real(1e-30) ? probability : Real(1e-30));
  // Rounding of alpha and of 1 - alpha may push the ratio past its bound. NaN stays NaN, for the
  // optimiser to leave out.
  const Real bounded = ratio > 1 ? Real(1) : ratio;
  return role == FragmentRole::winner ? bounded : -bounded;
}

}  // namespace tureen::trainer::kernels
