// Differences between two images, in the measures that the project reports. Reports must name both
// images: two renderings of one model, or a rendering and a photograph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "image/image.hpp"
#include "image/ssim.hpp"

namespace tureen {

struct MetricOptions {
  SsimBorder ssim_border = SsimBorder::zero_pad;
  /// Largest channel difference of a pixel that passes, for failing_fraction. The default accepts a
  /// rounding step of 8 bits, plus slack for float arithmetic.
  double pixel_tolerance = 1.0 / 255 + 1e-6;
  /// Smallest alpha of a covered pixel; the scene's alpha_threshold.
  float alpha_threshold = 0.5f;
  /// Whether FLIP is computed. It takes most of the time; if false, `flip` is 0.
  bool with_flip = true;
  /// One per pixel, not 0 for pixels that do not count in mae, mse, psnr_db, ssim and flip; empty:
  /// all count. The images should be equal there (equate_ignored).
  std::span<const std::uint8_t> ignored = {};
};

/// Over R, G and B, clamped to [0, 1], summed in double precision. Alpha affects only
/// coverage_mismatch and non_finite. NaN counts as 0 and is counted in non_finite.
struct Metrics {
  double mae = 0;
  double mse = 0;
  double psnr_db = 0;  // -10 log10 of mse, at most 100
  double ssim = 0;
  double flip = 0;     // mean FLIP (LDR, 67 pixels per degree)
  double max_abs = 0;  // largest channel difference
  /// 99.9th percentile over all channels. Rendering bugs often affect only the 0.1 % of differences
  /// above it; see max_abs.
  double p999_abs = 0;
  /// Fraction of pixels that only one image covers (MetricOptions::alpha_threshold).
  double coverage_mismatch = 0;
  double failing_fraction = 0;  // of pixels, see MetricOptions
  std::size_t non_finite = 0;   // pixels with a NaN or an infinity in either image
};

/// -10 log10(mse), at most 100 dB, the value for equal images.
double psnr_from_mse(double mse);

/// The mean squared error as in Metrics::mse, without the other metrics. Throws UsageError if the
/// sizes differ or an image is empty.
double mean_squared_error(const ImageF& a, const ImageF& b);

/// All metrics above. Throws UsageError if the sizes differ, an image is empty, or the SSIM window
/// does not fit.
Metrics compare(const ImageF& a, const ImageF& b, const MetricOptions& options = {});

/// Copies the pixels of `from` to `to` where `ignored` is 1, so that they do not differ. `ignored`
/// has one value per pixel, or is empty. Returns the factor from a mean error over all pixels to
/// that over the pixels that are not ignored, at least 1; 1 if all are ignored.
double equate_ignored(const ImageF& from, std::span<const std::uint8_t> ignored, ImageF& to);

/// |a - b| of R, G and B of every pixel as in Metrics, row by row from the top, in [0, 1].
std::vector<float> channel_differences(const ImageF& a, const ImageF& b);

/// The largest channel difference of each pixel, row by row from the top.
std::vector<float> difference_map(const ImageF& a, const ImageF& b);

/// The image over an opaque background, as a screen shows it; straight alpha. Alpha is unchanged,
/// so coverage can still be compared.
ImageF composited(const ImageF& image, glm::vec3 background);

}  // namespace tureen
