// Adam (Kingma and Ba, arXiv 1412.6980, algorithm 1) and VectorAdam (Ling et al., arXiv
// 2205.13599). VectorAdam divides a vector by the root mean square of its past norms, so the step
// does not depend on the axes.
#pragma once

#include <cmath>

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::kernels {

/// Constants of one step: the rate, and the corrections for moments that start at 0.
struct AdamStep {
  float beta1, beta2, epsilon;
  float rate_over_correction1;     // rate / (1 - beta1^t)
  float inverse_root_correction2;  // 1 / sqrt(1 - beta2^t)
};

TUREEN_HOST_DEVICE AdamStep adam_step(float rate, float beta1, float beta2, float epsilon,
                                      double t) {
  return {beta1, beta2, epsilon, float(rate / (1 - std::pow(double(beta1), t))),
          float(1 / std::sqrt(1 - std::pow(double(beta2), t)))};
}

/// Whether the gradient, its square, and the sum of three such squares are finite. An infinite
/// second moment would stop its parameter for the rest of the run.
TUREEN_HOST_DEVICE bool can_be_squared(float gradient) {
  return std::isfinite(4 * gradient * gradient);
}

TUREEN_HOST_DEVICE void adam(const AdamStep& step, float gradient, float& value, float& first,
                             float& second) {
  first = step.beta1 * first + (1 - step.beta1) * gradient;
  second = step.beta2 * second + (1 - step.beta2) * gradient * gradient;
  value -= step.rate_over_correction1 * first /
           (std::sqrt(second) * step.inverse_root_correction2 + step.epsilon);
}

TUREEN_HOST_DEVICE void vector_adam(const AdamStep& step, const float (&gradient)[3], float* value,
                                    float* first, float& second) {
  const float squared =
      gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
  second = step.beta2 * second + (1 - step.beta2) * squared;
  const float scale = step.rate_over_correction1 /
                      (std::sqrt(second) * step.inverse_root_correction2 + step.epsilon);
  for (int i = 0; i < 3; ++i) {
    first[i] = step.beta1 * first[i] + (1 - step.beta1) * gradient[i];
    value[i] -= scale * first[i];
  }
}

}  // namespace tureen::trainer::kernels
