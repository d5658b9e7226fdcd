// Images in memory. Row 0 is the top row; values are display-referred sRGB with straight alpha.
#pragma once

#include <cstdint>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace tureen {

/// Pixels of four channels.
template <class Pixel>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Pixel> pixels;  // width * height, row by row

  Image() = default;
  Image(int w, int h, Pixel fill = Pixel(0))
      : width(w), height(h), pixels(std::size_t(w) * h, fill) {}
  Pixel& at(int x, int y) { return pixels[std::size_t(y) * width + x]; }
  const Pixel& at(int x, int y) const { return pixels[std::size_t(y) * width + x]; }
};

/// 8 bits a channel, value = byte / 255.
using Image8 = Image<glm::u8vec4>;

/// Float channels, nominally in [0, 1]; alpha is coverage.
using ImageF = Image<glm::vec4>;

/// Rounds to the nearest of 256 values, as a GL framebuffer does. Clamps; NaN becomes 0.
Image8 quantised(const ImageF& image);

/// FNV-1a hash (64 bits) of the bytes, row by row from the top, as 16 hexadecimal digits. Equal
/// hashes mean equal images for testing; the hash is not cryptographic.
std::string pixels_hash(const Image8& image);

/// byte / 255.
ImageF to_float(const Image8& image);

}  // namespace tureen
