#include "trainer/diffsoup/texture_level.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tureen::trainer {

namespace {

// A level more costs up to 1.8 times the time of a step. 1,000 triangles on lego at 200x200 have 20
// pixels each; level 4 brings 0.7 dB there on the training images, level 5 another 0.4, and none on
// others. 15,000 on the fox at 270x480 have 17 pixels; level 4 brings nothing.
constexpr double texels_a_pixel = 3.5;
constexpr int lowest = 3;
// A triangle of average size never has more than a few hundred pixels in one image, and texels cost
// time and memory in every step.
constexpr int highest = 6;

double covered_pixels(const Photograph& photograph) {
  double covered = 0;
  for (std::size_t i = 0; i < photograph.image.pixels.size(); ++i)
    covered += photograph.image.pixels[i].a >= 128 &&
               (photograph.ignored.empty() || photograph.ignored[i] == 0);
  return covered;
}

}  // namespace

int fitting_level(const Dataset& dataset, int triangles) {
  double covered = 0;
  for (const Photograph& photograph : dataset.train) covered += covered_pixels(photograph);
  covered /= double(std::max<std::size_t>(dataset.train.size(), 1));
  const double texels = texels_a_pixel * covered / (0.5 * triangles);
  // A lattice of level L has about 4^L / 2 texels.
  const double level = 0.5 * std::log2(std::max(2 * texels, 1.0));
  return std::clamp(int(std::lround(level)), lowest, highest);
}

Config with_fitting_level(const Config& config, const Dataset& dataset) {
  Config fitting = config;
  if (fitting.max_level == automatic_level)
    fitting.max_level = std::max(fitting_level(dataset, fitting.triangles), fitting.min_level);
  return fitting;
}

}  // namespace tureen::trainer
