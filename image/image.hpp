// Images in memory. Row 0 is the top row; values are display-referred sRGB with straight alpha.
#pragma once

#include <cstdint>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace tureen {

/// 8 bits a channel, value = byte / 255.
struct Image8 {
  int width = 0;
  int height = 0;
  std::vector<glm::u8vec4> pixels;  // width * height, row by row

  Image8() = default;
  Image8(int w, int h, glm::u8vec4 fill = glm::u8vec4(0))
      : width(w), height(h), pixels(std::size_t(w) * h, fill) {}
  glm::u8vec4& at(int x, int y) { return pixels[std::size_t(y) * width + x]; }
  const glm::u8vec4& at(int x, int y) const { return pixels[std::size_t(y) * width + x]; }
};

/// Float channels, nominally in [0, 1]; alpha is coverage.
struct ImageF {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> pixels;

  ImageF() = default;
  ImageF(int w, int h, glm::vec4 fill = glm::vec4(0))
      : width(w), height(h), pixels(std::size_t(w) * h, fill) {}
  glm::vec4& at(int x, int y) { return pixels[std::size_t(y) * width + x]; }
  const glm::vec4& at(int x, int y) const { return pixels[std::size_t(y) * width + x]; }
};

/// Rounds to the nearest of 256 values, as a GL framebuffer does. Clamps; NaN becomes 0.
Image8 quantised(const ImageF& image);

/// FNV-1a hash (64 bits) of the bytes, row by row from the top, as 16 hexadecimal digits. Equal
/// hashes mean equal images for testing; the hash is not cryptographic.
std::string pixels_hash(const Image8& image);

/// byte / 255.
ImageF to_float(const Image8& image);

}  // namespace tureen
