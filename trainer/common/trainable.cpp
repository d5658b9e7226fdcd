#include "trainer/common/trainable.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tureen::trainer {

int Trainable::steps_in(double seconds, double seconds_per_work) const {
  // The mean work of a step stays; a run of 10 million steps would take weeks.
  const double work = std::max(work_left(), work_of_step());
  const double mean = work / std::max(steps() - steps_done(), 1);
  return steps_done() + int(std::min(std::round(seconds / (seconds_per_work * mean)), 1e7));
}

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
