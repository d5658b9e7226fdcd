#include "trainer/diffsoup/held_out.hpp"

#include <algorithm>
#include <cassert>

#include "image/heat_map.hpp"
#include "image/metrics.hpp"
#include "image/quantise.hpp"

namespace tureen::trainer {

namespace {

ImageF truth(const Photograph& view, const Config& config) {
  const float* color = config.background;
  return composited(to_float(view.image), {color[0], color[1], color[2]});
}

}  // namespace

Image8 drawn(Backend& backend, const Camera& camera) {
  const std::vector<float> planes = backend.render(camera);
  Image8 image(camera.width, camera.height);
  const std::size_t pixels = image.pixels.size();
  assert(planes.size() == 3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p)
    image.pixels[p] = {quantised_unit(planes[p]), quantised_unit(planes[pixels + p]),
                       quantised_unit(planes[2 * pixels + p]), 255};
  return image;
}

double mean_psnr_db(Backend& backend, std::span<const Photograph> views, const Config& config,
                    const std::function<void(double)>& progress) {
  assert(!views.empty());
  double sum = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (progress) progress(double(i) / double(views.size()));
    sum += psnr_from_mse(
        mean_squared_error(truth(views[i], config), to_float(drawn(backend, views[i].camera))));
  }
  return sum / double(views.size());
}

Image8 preview(Backend& backend, const Photograph& view, const Config& config) {
  Image8 image = side_by_side(truth(view, config), to_float(drawn(backend, view.camera)));
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
