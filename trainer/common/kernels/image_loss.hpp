// The loss between a rendered image C and a photograph G, and its derivative, for one pixel and one
// window: L1 and SSIM (Wang, Bovik, Sheikh and Simoncelli 2004, equation 13; 11 x 11 Gaussian
// windows of sigma 1.5 inside the image, C1 = 0.01^2, C2 = 0.03^2).
//
// SSIM is written in sums and differences, s = C + G - 1 and d = C - G, instead of C and G. With
// weighted means over a window and M = mean(s) + 1, D = mean(d):
//
//   A1 = (M^2 - D^2) / 2 + C1       A2 = (var(s) - var(d)) / 2 + C2
//   B1 = (M^2 + D^2) / 2 + C1       B2 = (var(s) + var(d)) / 2 + C2
//   1 - SSIM = (B1 B2 - A1 A2) / (B1 B2) = (B1 var(d) + A2 D^2) / (B1 B2)
//
// This form needs four moments instead of five. In training the images are similar, and the small
// result is then a product of small numbers, not a difference of large ones. In single precision
// 1 - SSIM and its derivative are exact to rounding for equal images, even for flat ones.
#pragma once

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer {

/// Width and height of the window in pixels. Its weights are the product of a row and a column.
inline constexpr int ssim_window = 11;

/// The weight at `offset` pixels from the centre, 0..5: exp(-offset^2 / 4.5), normalised so that
/// the eleven weights sum to 1.
TUREEN_HOST_DEVICE constexpr double ssim_weight(int offset) {
  const double weights[] = {0.26601172486179436, 0.2130055377112537,   0.10936068950970002,
                            0.03600077212843083, 0.007598758135239185, 0.00102838008447911};
  return weights[offset];
}

/// One channel of a pixel: the arguments of the moments.
template <class Real>
struct SsimPixel {
  Real sum;         // C + G - 1: centred, so variances of bright flat regions keep their digits
  Real difference;  // C - G
};

template <class Real>
TUREEN_HOST_DEVICE SsimPixel<Real> ssim_pixel(Real rendered, Real target) {
  return {rendered + (target - Real(1)), rendered - target};
}

/// Weighted means over a window.
template <class Real>
struct SsimMoments {
  Real sum, difference, sum_squared, difference_squared;
};

/// 1 - SSIM of a window, and its coefficients for the derivatives of its pixels.
template <class Real>
struct SsimDissimilarity {
  Real value;
  Real by_sum_variance, by_difference_variance;
  Real constant;  // the part of the derivative that all pixels share
};

template <class Real>
TUREEN_HOST_DEVICE SsimDissimilarity<Real> ssim_dissimilarity(const SsimMoments<Real>& mean) {
  const Real c1 = Real(0.01 * 0.01), c2 = Real(0.03 * 0.03);
  // E[x^2] - E[x]^2 cancels in flat regions and may be below zero.
  const Real raw_s = mean.sum_squared - mean.sum * mean.sum;
  const Real raw_d = mean.difference_squared - mean.difference * mean.difference;
  const Real variance_s = raw_s > Real(0) ? raw_s : Real(0);
  const Real variance_d = raw_d > Real(0) ? raw_d : Real(0);
  const Real m = mean.sum + Real(1), d = mean.difference;
  const Real mm = m * m, dd = d * d;
  const Real a1 = (mm - dd) * Real(0.5) + c1, b1 = (mm + dd) * Real(0.5) + c1;
  const Real a2 = (variance_s - variance_d) * Real(0.5) + c2;
  const Real b2 = (variance_s + variance_d) * Real(0.5) + c2;
  const Real scale = Real(1) / (b1 * b2);  // the denominator is at least C1 C2 = 9e-8
  const Real over_b1 = b2 * scale, over_b2 = b1 * scale;
  const Real luminance = a1 * over_b1, structure = a2 * over_b2;
  const Real by_variance = Real(0.5) * luminance * over_b2 * over_b2;

  SsimDissimilarity<Real> result;
  result.value = (b1 * variance_d + a2 * dd) * scale;
  result.by_sum_variance = -by_variance * variance_d;
  result.by_difference_variance = by_variance * (variance_s + 2 * c2);
  const Real by_means = structure * over_b1 * over_b1 * d * (mm + 2 * c1 - m * d);
  result.constant = by_means - 2 * (result.by_sum_variance * mean.sum +
                                    result.by_difference_variance * mean.difference);
  return result;
}

/// The derivative of the sum of 1 - SSIM over all windows by a pixel's C. `by_sum_variance`,
/// `by_difference_variance` and `constant` are sums over the windows that contain the pixel,
/// weighted by the pixel's weight in each.
template <class Real>
TUREEN_HOST_DEVICE Real ssim_derivative(const SsimPixel<Real>& pixel, Real by_sum_variance,
                                        Real by_difference_variance, Real constant) {
  return 2 * (pixel.sum * by_sum_variance + pixel.difference * by_difference_variance) + constant;
}

/// The derivative of |C - G|; 0 if they are equal.
template <class Real>
TUREEN_HOST_DEVICE Real sign(Real difference) {
  return Real(difference > Real(0)) - Real(difference < Real(0));
}

}  // namespace tureen::trainer
