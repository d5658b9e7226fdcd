#include "trainer/diffsoup/texture_level.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tureen::trainer {

namespace {

// With this number, level 4 begins at 18 pixels a triangle, between two measurements. With 20
// pixels (1,000 triangles, lego at 200x200) level 4 has 0.7 dB more than level 3 on the training
// images and 0.2 dB more on test images. With 17 (15,000 triangles, the fox at 270x480) it has no
// more, and a step takes 1.8 times as long.
constexpr double texels_a_pixel = 3.5;
constexpr int lowest = 3;

double covered_pixels(const Photograph& photograph) {
  double covered = 0;
  const Image8 image = photograph.image();
  const std::vector<std::uint8_t> ignored = photograph.ignored();
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    covered += image.pixels[i].a >= 128 && (ignored.empty() || ignored[i] == 0);
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
  return std::clamp(int(std::lround(level)), lowest, highest_automatic_level);
}

Config with_fitting_level(const Config& config, const Dataset& dataset) {
  Config fitting = config;
  if (fitting.max_level == automatic_level)
    fitting.max_level = std::max(fitting_level(dataset, fitting.triangles), fitting.min_level);
  return fitting;
}

}  // namespace tureen::trainer
