// An image copied by a full-screen triangle: the upper limit of speed of every pass over all
// pixels. The limit for triangles is the runtime's own pipeline with ShadingSite::nowhere.
#pragma once

#include <glm/vec2.hpp>

#include "image/image.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/passes/full_screen.hpp"

namespace tureen {

class CopyCeiling {
 public:
  /// The context must be current for every call, and on destruction.
  explicit CopyCeiling(const gl::Context& context);

  /// Copies width x height RGBA8 pixels from one texture to another of that size. Returns before
  /// the device has finished. Throws DeviceLimitError if the device lacks the memory.
  void draw(int width, int height);

  /// Waits for the device.
  void finish() const;

  /// The last copy, row 0 on top. Waits for the device. Asserts that a copy was drawn.
  Image8 read_copy() const;

 private:
  void resize(glm::ivec2 size);

  gl::Program program_;
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  gl::Texture from_, to_;
  gl::Framebuffer from_framebuffer_, to_framebuffer_;
};

}  // namespace tureen
