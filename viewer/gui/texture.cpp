#include "viewer/gui/texture.hpp"

#include <cstdint>

#include "runtime/gl/state.hpp"

namespace tureen::viewer {

ImageTexture::ImageTexture(const Image8& image)
    : texture_(gl::Texture::create()), size_(image.width, image.height) {
  gl::use_plain_pixel_transfer();
  glBindTexture(GL_TEXTURE_2D, texture_.id());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               image.pixels.data());
}

void* ImageTexture::id() const {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): Dear ImGui stores GL names as pointers
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture_.id()));
}

}  // namespace tureen::viewer
