// SSIM: how alike the local structure of two pictures is (Wang, Bovik, Sheikh and Simoncelli,
// "Image quality assessment: from error visibility to structural similarity", 2004, equation 13).
#pragma once

#include "image/image.hpp"

namespace tureen {

/// The window and what happens at the border. The three give different numbers for the same
/// pictures (0.829, 0.821 and 0.828 in one case): always say which one was used.
enum class SsimBorder {
  zero_pad,  // Gaussian, 11 x 11, sigma 1.5, zeros around the picture: 3DGS, Triangle Splatting
  valid,     // the same window, where it fits: DiffSoup on real scenes
  uniform7,  // box of 7 x 7 where it fits, sample variance (49/48): scikit-image's default
};

/// "zero_pad", "valid", "uniform7".
const char* name(SsimBorder border);

/// The mean over all windows and over R, G and B of values clamped to [0, 1] (NaN becomes 0), with
/// C1 = 0.01^2 and C2 = 0.03^2; alpha is ignored. 1 for equal pictures, down to -1. The pictures
/// have equal sizes. Throws UsageError when no window fits inside them.
double ssim(const ImageF& a, const ImageF& b, SsimBorder border = SsimBorder::zero_pad);

}  // namespace tureen
