#include "trainer/common/training_views.hpp"

#include <cassert>

namespace tureen::trainer {

namespace {

/// One channel over the background, straight alpha. Opaque bytes do not change.
std::uint8_t composited(std::uint8_t value, std::uint8_t alpha, float background) {
  const double opacity = alpha / 255.0;
  return static_cast<std::uint8_t>(opacity * value + (1 - opacity) * 255.0 * background + 0.5);
}

}  // namespace

TrainingView training_view(const Photograph& photograph, std::span<const float, 3> background) {
  const Image8& image = photograph.image;
  assert(image.width == photograph.camera.width && image.height == photograph.camera.height);
  const std::size_t pixels = image.pixels.size();
  TrainingView view{.camera = photograph.camera, .target = {}, .ignored = {}};
  view.target.resize(3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    const glm::u8vec4 pixel = image.pixels[p];
    for (int c = 0; c < 3; ++c)
      view.target[std::size_t(c) * pixels + p] =
          composited(pixel[c], pixel.a, background[std::size_t(c)]);
  }
  return view;
}

std::vector<TrainingView> take_training_views(std::vector<Photograph>& photographs,
                                              std::span<const float, 3> background) {
  std::vector<TrainingView> views;
  views.reserve(photographs.size());
  for (Photograph& photograph : photographs) {
    views.push_back(training_view(photograph, background));
    photograph.image = {};
  }
  return views;
}

}  // namespace tureen::trainer
