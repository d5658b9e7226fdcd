#include "image/image.hpp"

#include "image/quantise.hpp"

namespace tureen {

Image8 quantised(const ImageF& image) {
  Image8 result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c) result.pixels[i][c] = quantised_unit(image.pixels[i][c]);
  return result;
}

std::string pixels_hash(const Image8& image) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](std::uint8_t byte) { hash = (hash ^ byte) * 0x100000001b3u; };
  for (const glm::u8vec4& pixel : image.pixels)
    for (int channel = 0; channel < 4; ++channel) add(pixel[channel]);
  constexpr const char* digits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t i = text.size(); i-- > 0; hash >>= 4) text[i] = digits[hash & 15];
  return text;
}

ImageF to_float(const Image8& image) {
  ImageF result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    result.pixels[i] = glm::vec4(image.pixels[i]) / 255.0f;
  return result;
}

}  // namespace tureen
