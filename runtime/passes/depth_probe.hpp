// Reads single pixels of a depth texture. OpenGL ES can read back only colours.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"

namespace tureen {

class DepthProbe {
 public:
  explicit DepthProbe(gl::Api api);

  /// The value in the texture; column and row are counted from the bottom left. Waits for the
  /// device.
  float read(GLuint depth_texture, glm::ivec2 pixel);

 private:
  gl::Program program_;
  gl::VertexArray nothing_ = gl::VertexArray::create();
  gl::Texture bits_;
  gl::Framebuffer framebuffer_;
};

}  // namespace tureen
