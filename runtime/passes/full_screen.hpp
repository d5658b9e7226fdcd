// One triangle over the whole target, for passes that compute every sample.
#pragma once

#include "runtime/gl/objects.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/shader_source.hpp"

namespace tureen {

/// The program that computes every sample with this fragment shader.
inline gl::Program full_screen_program(const ShaderSource& fragment, gl::Api api) {
  return gl::Program(assemble({.file = "full_screen.vert"}, api), assemble(fragment, api));
}

class FullScreen {
 public:
  /// Draws at a depth from -1 or 0 to 1, by the clip control. `program` is in use; its vertex
  /// shader is full_screen.vert.
  void draw(const gl::Program& program, float depth = 0) {
    program.set("background_depth", depth);
    nothing_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  /// See Renderer::leave_context().
  void leave_context() { nothing_.forget(); }

 private:
  gl::LocalVertexArray nothing_;
};

}  // namespace tureen
