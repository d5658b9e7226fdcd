// SSIM: the similarity of local structure of two images (Wang, Bovik, Sheikh and Simoncelli, "Image
// quality assessment: from error visibility to structural similarity", 2004, equation 13).
#pragma once

#include <cstdint>
#include <span>

#include "image/image.hpp"

namespace tureen {

/// The window and the border. The three variants give different numbers for the same images (0.829,
/// 0.821 and 0.828 in one example), so every report names the variant.
enum class SsimBorder {
  zero_pad,  // Gaussian, 11 x 11, sigma 1.5, zeros around the image: 3DGS, Triangle Splatting
  valid,     // the same window, where it fits: DiffSoup on real scenes
  uniform7,  // box of 7 x 7 where it fits, sample variance (49/48): scikit-image's default
};

/// "zero_pad", "valid", "uniform7".
const char* name(SsimBorder border);

/// The mean over all windows and over R, G and B, clamped to [0, 1] (NaN becomes 0), with C1 =
/// 0.01^2 and C2 = 0.03^2. Alpha is ignored. Range -1..1; 1 for equal images. The images have equal
/// sizes. Throws UsageError if no window fits inside them.
///
/// Windows around pixels with a value other than 0 in `ignored` (one a pixel, or empty) do not
/// count; 1 if none counts.
double ssim(const ImageF& a, const ImageF& b, SsimBorder border = SsimBorder::zero_pad,
            std::span<const std::uint8_t> ignored = {});

}  // namespace tureen
