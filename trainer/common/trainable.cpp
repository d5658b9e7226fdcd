#include "trainer/common/trainable.hpp"

#include <cassert>

namespace tureen::trainer {

std::optional<ImageF> Trainable::exact_image(const FrameInput& input) {
  const std::vector<float> planes = render(input.camera);
  ImageF image(input.camera.width, input.camera.height);
  const std::size_t pixels = image.pixels.size();
  assert(planes.size() == 3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p)
    image.pixels[p] = {planes[p], planes[pixels + p], planes[2 * pixels + p], 1};
  return image;
}

}  // namespace tureen::trainer
