#include "jobs/conversion/conversion_loss.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "camera/camera_sets.hpp"
#include "camera/navigation.hpp"
#include "image/image.hpp"
#include "runtime/splats/tile_images.hpp"

namespace tureen {

namespace {

constexpr std::size_t compared_views = 16, most_recorded = 8;
constexpr int compared_side = 800;
/// Of the distance at which the whole scene is visible: so near that single splats are.
constexpr double near_distance = 1.0 / 3;

std::vector<Camera> views_of(const Scene& scene) {
  std::vector<Camera> views;
  const std::size_t recorded = std::min(scene.cameras.size(), most_recorded);
  for (std::size_t i = 0; i < recorded; ++i) {
    const Camera& camera = scene.cameras[i * scene.cameras.size() / recorded];
    const double scale = double(compared_side) / std::max(camera.width, camera.height);
    views.push_back(scale >= 1 ? camera
                               : resized(camera, std::max(1, int(camera.width * scale)),
                                         std::max(1, int(camera.height * scale))));
  }
  const Subject subject = subject_of(scene);
  const std::vector<Camera> around =
      hemisphere(subject, int(compared_views - recorded),
                 Lens{.width = compared_side, .height = compared_side});
  for (std::size_t i = 0; i < around.size(); ++i) {
    Camera camera = around[i];
    if (i % 2 == 1)
      camera.view_from_world *= at_origin((camera.eye() - subject.center()) * (1 - near_distance));
    views.push_back(std::move(camera));
  }
  return views;
}

/// Sum over all channels, of values in 0..1.
double squared_error(const Image8& a, const Image8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += std::pow((a.pixels[i][c] - b.pixels[i][c]) / 255.0, 2);
  return sum;
}

double psnr(double mean_squared) {
  return mean_squared > 0 ? std::min(100.0, -10 * std::log10(mean_squared)) : 100;
}

}  // namespace

bool is_measurable(const Scene& scene) {
  return std::all_of(scene.layers.begin(), scene.layers.end(), [](const Layer& layer) {
    return std::holds_alternative<Splats>(layer.primitives);
  });
}

ConversionLoss conversion_loss(const Scene& before, const Scene& after,
                               const std::function<void(double)>& progress) {
  const std::vector<Camera> views = views_of(before);
  TileImages expected(before, before.info.background), found(after, before.info.background);
  ConversionLoss loss{.views = views.size(), .worst_psnr_db = 100};
  double squared = 0, values = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    progress(double(i) / double(views.size()));
    const double error = squared_error(expected.image({views[i]}), found.image({views[i]}));
    const double size = 3.0 * views[i].width * views[i].height;
    squared += error;
    values += size;
    loss.worst_psnr_db = std::min(loss.worst_psnr_db, psnr(error / size));
  }
  loss.psnr_db = psnr(squared / values);
  return loss;
}

}  // namespace tureen
