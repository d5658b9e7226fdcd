#include "image/render_error.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tureen {

void RenderErrorMeter::add(const ImageF& reference, const ImageF& drawn) {
  views_.push_back(compare(reference, drawn, options_));
  pixels_.push_back(double(reference.pixels.size()));
  const double steps = double(histogram_.size() - 1);
  for (const float difference : channel_differences(reference, drawn))
    ++histogram_[std::size_t(std::ceil(double(difference) * steps))];
}

RenderError RenderErrorMeter::result() const {
  assert(!views_.empty());
  RenderError error;
  error.worst_psnr_db = views_.front().psnr_db;
  double pixels = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const Metrics& view = views_[i];
    pixels += pixels_[i];
    error.mse += pixels_[i] * view.mse;
    error.mae += pixels_[i] * view.mae;
    error.coverage_mismatch += pixels_[i] * view.coverage_mismatch;
    error.max_abs = std::max(error.max_abs, view.max_abs);
    error.ssim += view.ssim / double(views_.size());
    error.flip += view.flip / double(views_.size());
    error.mean_psnr_db += view.psnr_db / double(views_.size());
    error.worst_psnr_db = std::min(error.worst_psnr_db, view.psnr_db);
    error.non_finite += view.non_finite;
    error.view_psnr_db.push_back(view.psnr_db);
  }
  error.mse /= pixels;
  error.mae /= pixels;
  error.coverage_mismatch /= pixels;
  error.psnr_db = psnr_from_mse(error.mse);

  // The 99.9th percentile by nearest rank.
  const auto rank = std::uint64_t(std::ceil(0.999 * 3.0 * pixels));
  std::uint64_t below = 0;
  for (std::size_t step = 0; step < histogram_.size(); ++step) {
    below += histogram_[step];
    if (below < rank) continue;
    error.p999_abs = double(step) / double(histogram_.size() - 1);
    break;
  }
  return error;
}

double decibels_lost(double model_db, double render_db) {
  return 10.0 * std::log10(1.0 + std::pow(10.0, (model_db - render_db) / 10.0));
}

}  // namespace tureen
