// E_render: the error of an approximation over several views of a scene. The reference is the
// unchanged scene rendered by the oracle, never a photograph. The error against photographs is
// another quantity, and the two never share an axis (docs/tradeoff.md).
#pragma once

#include <cstdint>
#include <vector>

#include "image/metrics.hpp"

namespace tureen {

/// Over all pixels of all views, as if they were one image. SSIM and FLIP are means over the views.
/// Units as in Metrics.
struct RenderError {
  double psnr_db = 0;        // from the mean squared error of all views together
  double mean_psnr_db = 0;   // mean of the PSNR of each view, as papers report it
  double worst_psnr_db = 0;  // PSNR of the worst view
  double mse = 0;
  double mae = 0;
  double max_abs = 0;
  double p999_abs = 0;  // at most 1/65536 above the true value
  double ssim = 0;
  double flip = 0;
  double coverage_mismatch = 0;
  std::size_t non_finite = 0;  // pixels
  std::vector<double> view_psnr_db;
};

/// Accumulates one view at a time and stores no image. Memory grows by one figure a view.
class RenderErrorMeter {
 public:
  explicit RenderErrorMeter(MetricOptions options = {}) : options_(options) {}

  /// Both images are already composited over the same background; their alpha is coverage. Throws
  /// the errors of compare().
  void add(const ImageF& reference, const ImageF& drawn);

  /// Asserts at least one view.
  RenderError result() const;

 private:
  MetricOptions options_;
  std::vector<Metrics> views_;
  std::vector<double> pixels_;  // of each view: its weight
  /// Number of channels per difference, in units of 1/65536, rounded up.
  std::vector<std::uint64_t> histogram_ = std::vector<std::uint64_t>(65537);
};

/// The loss in PSNR against photographs that the rendering error causes, in dB. `model_db` is the
/// PSNR of the exact model, `render_db` that of the rendering error. For uncorrelated errors the
/// loss is 10 log10(1 + 10^((model - render) / 10)). Example: a model of 27 dB loses 0.02 dB at a
/// render_db of 50.
double decibels_lost(double model_db, double render_db);

}  // namespace tureen
