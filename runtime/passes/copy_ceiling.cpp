#include "runtime/passes/copy_ceiling.hpp"

#include <cassert>

#include "runtime/gl/program.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

struct CopyCeiling::State {
  gl::Program program;
  gl::VertexArray nothing = gl::VertexArray::create();
  int width = 0, height = 0;
  gl::Texture from, to;
  gl::Framebuffer from_framebuffer, to_framebuffer;

  void resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    from = make_target(target_formats::rgba8, width, height);
    to = make_target(target_formats::rgba8, width, height);
    from_framebuffer = make_framebuffer({from.id()});
    to_framebuffer = make_framebuffer({to.id()});
    // Many colours, because GPUs compress a cleared target and would not read it.
    gl::use_plain_rasterisation(width, height);
    glEnable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, from_framebuffer.id());
    constexpr int cells = 64;
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const float color[4] = {float(x) / cells, float(y) / cells,
                                float((x * 7 + y * 13) % 32) / 32, 1};
        glScissor(width * x / cells, height * y / cells, width / cells + 1, height / cells + 1);
        glClearBufferfv(GL_COLOR, 0, color);
      }
    glDisable(GL_SCISSOR_TEST);
    gl::check("CopyCeiling");
  }
};

CopyCeiling::CopyCeiling(const gl::Context& context) : state_(std::make_unique<State>()) {
  const gl::Api api = context.capabilities().api;
  state_->program = gl::Program(assemble({.file = "full_screen.vert"}, api),
                                assemble({.file = "copy.frag"}, api));
}

CopyCeiling::~CopyCeiling() = default;
CopyCeiling::CopyCeiling(CopyCeiling&&) noexcept = default;
CopyCeiling& CopyCeiling::operator=(CopyCeiling&&) noexcept = default;

void CopyCeiling::draw(int width, int height) {
  State& state = *state_;
  if (state.width != width || state.height != height) state.resize(width, height);
  gl::use_plain_rasterisation(width, height);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, state.to_framebuffer.id());
  state.program.use();
  state.program.set("background_depth", 0.0f);
  state.program.set_texture("image", 0, state.from.id());
  glBindVertexArray(state.nothing.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::check("CopyCeiling");
}

void CopyCeiling::finish() const { glFinish(); }

Image8 CopyCeiling::read_copy() const {
  assert(state_->width > 0 && "nothing has been copied");
  return read_pixels(state_->to_framebuffer.id(), state_->width, state_->height);
}

}  // namespace tureen
