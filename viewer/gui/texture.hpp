// An image on the device for the interface, such as a photograph or a heat map.
#pragma once

#include <glm/vec2.hpp>

#include "image/image.hpp"
#include "runtime/gl/objects.hpp"

namespace tureen::viewer {

class ImageTexture {
 public:
  ImageTexture() = default;
  /// Linear filtering. GL rejects images above the device's texture size; they appear black.
  explicit ImageTexture(const Image8& image);

  explicit operator bool() const { return static_cast<bool>(texture_); }
  glm::ivec2 size() const { return size_; }
  /// The texture id for Dear ImGui.
  void* id() const;

 private:
  gl::Texture texture_;
  glm::ivec2 size_{0};
};

}  // namespace tureen::viewer
