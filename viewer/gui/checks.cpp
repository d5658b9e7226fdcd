#include "viewer/gui/checks.hpp"

#include "runtime/gl/api.hpp"
#include "runtime/gl/state.hpp"

namespace tureen::viewer {

void Checks::draw(gl::Api api, glm::ivec2 size, double side) {
  if (!program_) program_ = full_screen_program({.file = "checks.frag"}, api);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  gl::use_plain_rasterisation(size.x, size.y);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  // image * alpha + checks * (1 - alpha); the sum of alphas is at least 1.
  glBlendFuncSeparate(GL_ONE_MINUS_DST_ALPHA, GL_DST_ALPHA, GL_ONE, GL_ONE);
  program_->use();
  program_->set("side", float(side));
  full_screen_.draw(*program_);
  glDisable(GL_BLEND);
}

}  // namespace tureen::viewer
