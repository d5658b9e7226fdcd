#include "soup/image.hpp"

#include <algorithm>
#include <cmath>

namespace tureen {

Image8 quantised(const ImageF& image) {
  Image8 result(image.width, image.height);
  const auto to_byte = [](float value) {
    // NaN fails the comparison and takes the first branch.
    if (!(value > 0.0f)) return std::uint8_t(0);
    return static_cast<std::uint8_t>(std::min(value, 1.0f) * 255.0f + 0.5f);
  };
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c) result.pixels[i][c] = to_byte(image.pixels[i][c]);
  return result;
}

ImageF to_float(const Image8& image) {
  ImageF result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    result.pixels[i] = glm::vec4(image.pixels[i]) / 255.0f;
  return result;
}

}  // namespace tureen
