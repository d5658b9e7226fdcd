// An image on the device for the interface to show: a photograph, a heat map.
#pragma once

#include <glm/vec2.hpp>

#include "image/image.hpp"
#include "runtime/gl/objects.hpp"

namespace tureen::viewer {

class ImageTexture {
 public:
  ImageTexture() = default;
  /// Filtered linearly. Images wider or higher than the device's textures are refused by GL and
  /// show black.
  explicit ImageTexture(const Image8& image);

  explicit operator bool() const { return static_cast<bool>(texture_); }
  glm::ivec2 size() const { return size_; }
  /// As Dear ImGui takes it.
  void* id() const;

 private:
  gl::Texture texture_;
  glm::ivec2 size_{0};
};

}  // namespace tureen::viewer
