#include "jobs/bench/copy_ceiling.hpp"

#include <cassert>

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

CopyCeiling::CopyCeiling(const gl::Context& context)
    : program_(full_screen_program({.file = "copy.frag"}, context.capabilities().api)) {}

void CopyCeiling::resize(glm::ivec2 size) {
  size_ = size;
  from_ = make_target(target_formats::rgba8, size.x, size.y);
  to_ = make_target(target_formats::rgba8, size.x, size.y);
  from_framebuffer_ = make_framebuffer({from_.id()});
  to_framebuffer_ = make_framebuffer({to_.id()});
  // Many colours, because GPUs compress a cleared target and would not read it.
  gl::use_plain_rasterisation(size.x, size.y);
  glEnable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, from_framebuffer_.id());
  constexpr int cells = 64;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const float color[4] = {float(x) / cells, float(y) / cells, float((x * 7 + y * 13) % 32) / 32,
                              1};
      glScissor(size.x * x / cells, size.y * y / cells, size.x / cells + 1, size.y / cells + 1);
      glClearBufferfv(GL_COLOR, 0, color);
    }
  glDisable(GL_SCISSOR_TEST);
  gl::check("CopyCeiling");
}

void CopyCeiling::draw(int width, int height) {
  if (size_ != glm::ivec2(width, height)) resize({width, height});
  gl::use_plain_rasterisation(width, height);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, to_framebuffer_.id());
  program_.use();
  program_.set_texture("image", 0, from_.id());
  full_screen_.draw(program_);
  gl::check("CopyCeiling");
}

void CopyCeiling::finish() const { glFinish(); }

Image8 CopyCeiling::read_copy() const {
  assert(size_.x > 0 && "nothing has been copied");
  return read_pixels(to_framebuffer_.id(), size_.x, size_.y);
}

}  // namespace tureen
