// A picture on the device for the interface to show: a photograph, a heat map.
#pragma once

#include <glm/vec2.hpp>

#include "image/image.hpp"
#include "runtime/gl/objects.hpp"

namespace tureen::viewer {

class PictureTexture {
 public:
  PictureTexture() = default;
  /// Filtered linearly. Pictures wider or higher than the device's textures are refused by GL and
  /// show black.
  explicit PictureTexture(const Image8& image);

  explicit operator bool() const { return static_cast<bool>(texture_); }
  glm::ivec2 size() const { return size_; }
  /// As Dear ImGui takes it.
  void* id() const;

 private:
  gl::Texture texture_;
  glm::ivec2 size_{0};
};

}  // namespace tureen::viewer
