#include "jobs/conversion/conversion_loss.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "camera/survey_views.hpp"
#include "image/image.hpp"
#include "image/metrics.hpp"
#include "runtime/splats/tile_images.hpp"

namespace tureen {

namespace {

constexpr std::size_t compared_views = 16;
constexpr int compared_side = 800;

/// Sum over all channels, of values in 0..1.
double squared_error(const Image8& a, const Image8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += std::pow((a.pixels[i][c] - b.pixels[i][c]) / 255.0, 2);
  return sum;
}

}  // namespace

bool is_measurable(const Scene& scene) {
  return std::all_of(scene.layers.begin(), scene.layers.end(), [](const Layer& layer) {
    return std::holds_alternative<Splats>(layer.primitives);
  });
}

ConversionLoss conversion_loss(const Scene& before, const Scene& after,
                               const std::function<void(double)>& progress) {
  const std::vector<Camera> views = survey_views(before, compared_views, compared_side);
  TileImages expected(before, before.info.background), found(after, before.info.background);
  ConversionLoss loss{.views = views.size(), .worst_psnr_db = 100};
  double squared = 0, values = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    progress(double(i) / double(views.size()));
    const double error = squared_error(expected.image({views[i]}), found.image({views[i]}));
    const double size = 3.0 * views[i].width * views[i].height;
    squared += error;
    values += size;
    loss.worst_psnr_db = std::min(loss.worst_psnr_db, psnr_from_mse(error / size));
  }
  loss.psnr_db = psnr_from_mse(squared / values);
  return loss;
}

}  // namespace tureen
