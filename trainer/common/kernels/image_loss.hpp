// The loss between a rendered image C and a photograph G, and its derivative, a pixel and a
// window at a time: L1 and SSIM (Wang, Bovik, Sheikh and Simoncelli 2004, equation 13; 11 x 11
// Gaussian of sigma 1.5 where it fits, C1 = 0.01^2, C2 = 0.03^2).
//
// SSIM is written in sums and differences, s = C + G - 1 and d = C - G, instead of C and G. With
// weighted means over a window and M = mean(s) + 1, D = mean(d):
//
//   A1 = (M^2 - D^2) / 2 + C1       A2 = (var(s) - var(d)) / 2 + C2
//   B1 = (M^2 + D^2) / 2 + C1       B2 = (var(s) + var(d)) / 2 + C2
//   1 - SSIM = (B1 B2 - A1 A2) / (B1 B2) = (B1 var(d) + A2 D^2) / (B1 B2)
//
// Four moments instead of five; and what is small when the images are alike, as they are in
// training, is a product of small numbers and not a difference of large ones: in single precision
// 1 - SSIM and its derivative are exact to rounding for equal images, however flat.
#pragma once

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer {

/// The window is ssim_window pixels wide and high; its weights are a product of a row and a column.
inline constexpr int ssim_window = 11;

/// The weight at `offset` pixels from the centre, 0..5: exp(-offset^2 / 4.5), normalised to a sum
/// of one over the eleven.
TUREEN_HOST_DEVICE constexpr double ssim_weight(int offset) {
  const double weights[] = {0.26601172486179436, 0.2130055377112537,   0.10936068950970002,
                            0.03600077212843083, 0.007598758135239185, 0.00102838008447911};
  return weights[offset];
}

/// A pixel's channel: the arguments of the moments.
template <class Real>
struct SsimPixel {
  Real sum;         // C + G - 1: centred, so that variances of bright flat places keep their digits
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

/// 1 - SSIM of a window, and what its pixels need for their derivatives.
template <class Real>
struct SsimDissimilarity {
  Real value;
  Real by_sum_variance, by_difference_variance;
  Real constant;  // the part of a pixel's derivative that is the same for all
};

template <class Real>
TUREEN_HOST_DEVICE SsimDissimilarity<Real> ssim_dissimilarity(const SsimMoments<Real>& mean) {
  const Real c1 = Real(0.01 * 0.01), c2 = Real(0.03 * 0.03);
  // E[x^2] - E[x]^2 cancels where the image is flat and may come out below zero.
  const Real raw_s = mean.sum_squared - mean.sum * mean.sum;
  const Real raw_d = mean.difference_squared - mean.difference * mean.difference;
  const Real variance_s = raw_s > Real(0) ? raw_s : Real(0);
  const Real variance_d = raw_d > Real(0) ? raw_d : Real(0);
  const Real m = mean.sum + Real(1), d = mean.difference;
  const Real mm = m * m, dd = d * d;
  const Real a1 = (mm - dd) * Real(0.5) + c1, b1 = (mm + dd) * Real(0.5) + c1;
  const Real a2 = (variance_s - variance_d) * Real(0.5) + c2;
  const Real b2 = (variance_s + variance_d) * Real(0.5) + c2;
  const Real scale = Real(1) / (b1 * b2);  // at least C1 C2 = 9e-8 below the line
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

/// The derivative of the sum over all windows of 1 - SSIM by a pixel's C, where `by_sum_variance`,
/// `by_difference_variance` and `constant` are the sums over the windows that hold the pixel, each
/// times the pixel's weight in it.
template <class Real>
TUREEN_HOST_DEVICE Real ssim_derivative(const SsimPixel<Real>& pixel, Real by_sum_variance,
                                        Real by_difference_variance, Real constant) {
  return 2 * (pixel.sum * by_sum_variance + pixel.difference * by_difference_variance) + constant;
}

/// The derivative of |C - G|; 0 where they are equal.
template <class Real>
TUREEN_HOST_DEVICE Real sign(Real difference) {
  return Real(difference > Real(0)) - Real(difference < Real(0));
}

}  // namespace tureen::trainer
