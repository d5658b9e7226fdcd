#include "soup/image.hpp"

#include "soup/quantise.hpp"

namespace tureen {

Image8 quantised(const ImageF& image) {
  Image8 result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c) result.pixels[i][c] = quantised_unit(image.pixels[i][c]);
  return result;
}

ImageF to_float(const Image8& image) {
  ImageF result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    result.pixels[i] = glm::vec4(image.pixels[i]) / 255.0f;
  return result;
}

}  // namespace tureen
