// E_render: what a shortcut in drawing costs, over several views of one model. The reference is the
// same model drawn by the oracle, never a photograph; how near the model comes to photographs is
// another error, and the two are never put on one axis (docs/tradeoff.md).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "image/metrics.hpp"

namespace tureen {

/// Over all pixels of all views, as if they were one picture, but for SSIM and FLIP, which are
/// means over the views. Units as in Metrics.
struct RenderError {
  double psnr_db = 0;        // of the mean squared error of all views together
  double mean_psnr_db = 0;   // of the views' own decibels, as papers report them
  double worst_psnr_db = 0;  // of the worst view
  double mse = 0;
  double mae = 0;
  double max_abs = 0;
  double p999_abs = 0;  // within 1/65536 above the true value
  double ssim = 0;
  double flip = 0;
  double coverage_mismatch = 0;
  std::size_t non_finite = 0;  // pixels
  std::vector<double> view_psnr_db;
};

/// Takes view after view and keeps no picture: memory does not grow with their number but for one
/// figure a view.
class RenderErrorMeter {
 public:
  explicit RenderErrorMeter(MetricOptions options = {}) : options_(options) {}

  /// Both pictures are over the same background already, and their alpha is coverage. Throws what
  /// compare() throws.
  void add(const ImageF& reference, const ImageF& drawn);

  /// Asserts that there was a view.
  RenderError result() const;

 private:
  MetricOptions options_;
  std::vector<Metrics> views_;
  std::vector<double> pixels_;  // of each view: their weights
  /// How many channels differ by so many 65536ths, rounded up.
  std::vector<std::uint64_t> histogram_ = std::vector<std::uint64_t>(65537);
};

/// The part of a loss against photographs that drawing is to blame for: by how many decibels an
/// error of `render_db` lowers a model that comes within `model_db` of its photographs, if the two
/// are uncorrelated, 10 log10(1 + 10^((model - render) / 10)). 50 dB cost a model of 27 dB 0.02 dB.
double decibels_lost(double model_db, double render_db);

}  // namespace tureen
