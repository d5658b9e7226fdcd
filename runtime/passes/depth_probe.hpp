// Reads single pixels of a depth texture. OpenGL ES can read back only colours.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/gl/context.hpp"
#include "runtime/passes/full_screen.hpp"

namespace tureen {

class DepthProbe {
 public:
  explicit DepthProbe(gl::Api api);

  /// The value in the texture; column and row are counted from the bottom left. Waits for the
  /// device.
  float read(GLuint depth_texture, glm::ivec2 pixel);

 private:
  gl::Program program_;
  FullScreen full_screen_;
  gl::Texture bits_;
  gl::Framebuffer framebuffer_;
};

}  // namespace tureen
