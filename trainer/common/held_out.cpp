#include "trainer/common/held_out.hpp"

#include <algorithm>
#include <cassert>

#include "image/heat_map.hpp"
#include "image/metrics.hpp"

namespace tureen::trainer {

namespace {

ImageF truth(const Trainable& run, const Photograph& view) {
  const std::span<const float, 3> color = run.background();
  return composited(to_float(view.image()), {color[0], color[1], color[2]});
}

ImageF drawn(Trainable& run, const Photograph& view) { return to_float(run.image({view.camera})); }

}  // namespace

double mean_psnr_db(Trainable& run, std::span<const Photograph> views,
                    const std::function<void(double)>& progress) {
  assert(!views.empty());
  double sum = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (progress) progress(double(i) / double(views.size()));
    const ImageF rendering = drawn(run, views[i]);
    ImageF target = truth(run, views[i]);
    const double counted = equate_ignored(rendering, views[i].ignored(), target);
    sum += psnr_from_mse(counted * mean_squared_error(target, rendering));
  }
  return sum / double(views.size());
}

Image8 preview(Trainable& run, const Photograph& view) {
  Image8 image = side_by_side(truth(run, view), drawn(run, view));
  // The photograph is already composited on the background.
  for (glm::u8vec4& pixel : image.pixels) pixel.a = 255;
  return image;
}

std::vector<Photograph> some_of(std::span<const Photograph> views, std::size_t count) {
  count = std::min(count, views.size());
  std::vector<Photograph> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(views[i * views.size() / count]);
  return chosen;
}

}  // namespace tureen::trainer
