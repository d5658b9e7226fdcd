#include "runtime/passes/depth_probe.hpp"

#include <cstdint>
#include <cstring>

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

DepthProbe::DepthProbe(gl::Api api)
    : program_(full_screen_program({.file = "depth_probe.frag"}, api)),
      bits_(make_target(target_formats::rg32ui, 1, 1)),
      framebuffer_(make_framebuffer({bits_.id()})) {}

float DepthProbe::read(GLuint depth_texture, glm::ivec2 pixel) {
  gl::use_plain_rasterisation(1, 1);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  program_.use();
  program_.set_texture("depth", 0, depth_texture);
  program_.set("pixel", pixel);
  full_screen_.draw(program_);
  std::uint32_t bits[4] = {};
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  gl::use_plain_pixel_transfer();
  glReadPixels(0, 0, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, bits);
  glEnable(GL_DEPTH_TEST);
  gl::check("DepthProbe");
  float depth = 0;
  std::memcpy(&depth, bits, sizeof depth);
  return depth;
}

}  // namespace tureen
