// How far two pictures are apart, in the measures that the project reports. Always say which two
// pictures: the same model drawn in two ways, or a drawing and a photograph (ARCHITECTURE.md).
#pragma once

#include <cstddef>

#include "image/image.hpp"
#include "image/ssim.hpp"

namespace tureen {

struct MetricOptions {
  SsimBorder ssim_border = SsimBorder::zero_pad;
  /// failing_fraction counts pixels of which a channel is off by more than this. The default lets
  /// a rounding to 8 bits fall to the other side: one step, and slack for float arithmetic.
  double pixel_tolerance = 1.0 / 255 + 1e-6;
  /// A picture hits the pixels whose alpha is at least this; the scene's alpha_threshold.
  float alpha_threshold = 0.5f;
  /// FLIP takes most of the time; without it `flip` is 0.
  bool with_flip = true;
};

/// Over R, G and B of values clamped to [0, 1], sums in double precision; alpha decides coverage
/// and nothing else. NaN counts as 0 and is reported beside.
struct Metrics {
  double mae = 0;
  double mse = 0;
  double psnr_db = 0;  // -10 log10 of mse, at most 100
  double ssim = 0;
  double flip = 0;      // mean FLIP (LDR, 67 pixels per degree)
  double max_abs = 0;   // the largest difference in a channel
  double p999_abs = 0;  // 99.9 % of all channels differ by no more: rendering bugs live above
  double coverage_mismatch =
      0;  // fraction of pixels that only one picture hits (MetricOptions::alpha_threshold)
  double failing_fraction = 0;  // of pixels, see MetricOptions
  std::size_t non_finite = 0;   // pixels in which either picture has a NaN or an infinity
};

/// -10 log10(mse), at most 100: what equal pictures get.
double psnr_from_mse(double mse);

/// The mean squared difference as in Metrics::mse; for callers that need nothing else.
/// Throws UsageError when the sizes differ or a picture is empty.
double mean_squared_error(const ImageF& a, const ImageF& b);

/// All of the above. Throws UsageError when the sizes differ, a picture is empty, or the SSIM
/// window does not fit.
Metrics compare(const ImageF& a, const ImageF& b, const MetricOptions& options = {});

/// |a - b| of R, G and B of every pixel as in Metrics, row by row from the top, in [0, 1].
std::vector<float> channel_differences(const ImageF& a, const ImageF& b);

/// The largest difference in a channel, a pixel, row by row from the top.
std::vector<float> difference_map(const ImageF& a, const ImageF& b);

/// The picture over an opaque background, straight alpha: what a screen shows. Alpha stays as it
/// is, so coverage can still be compared.
ImageF composited(const ImageF& image, glm::vec3 background);

}  // namespace tureen
