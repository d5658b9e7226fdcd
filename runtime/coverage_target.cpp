#include "runtime/coverage_target.hpp"

#include "runtime/gl/state.hpp"
#include "runtime/shader_source.hpp"
#include "runtime/targets.hpp"
#include "soup/error.hpp"

namespace tureen {

namespace {

Renderbuffer make_samples(GLenum format, const CoverageTarget::Size& size, GLenum attachment) {
  Renderbuffer buffer = Renderbuffer::create();
  glBindRenderbuffer(GL_RENDERBUFFER, buffer.id());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, size.samples, format, size.width, size.height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer.id());
  return buffer;
}

}  // namespace

CoverageTarget::CoverageTarget(gl::Api api)
    : api_(api),
      resolve_(assemble({.file = "full_screen.vert"}, api),
               assemble({.file = "coverage_resolve.frag"}, api)) {}

void CoverageTarget::resize(const Size& size) {
  size_ = size;
  samples_framebuffer_ = gl::Framebuffer::create();
  glBindFramebuffer(GL_FRAMEBUFFER, samples_framebuffer_.id());
  color_ = make_samples(GL_RGBA8, size, GL_COLOR_ATTACHMENT0);
  depth_ = make_samples(size.depth_format, size, GL_DEPTH_ATTACHMENT);
  require_complete_framebuffer();
  resolved_ = make_target(target_formats::rgba8, size.width, size.height);
  resolved_framebuffer_ = make_framebuffer({resolved_.id()}, 0);
}

void CoverageTarget::begin(const glm::vec4& background) const {
  glBindFramebuffer(GL_FRAMEBUFFER, samples_framebuffer_.id());
#ifndef __EMSCRIPTEN__
  if (api_ == gl::Api::desktop) {
    glEnable(GL_MULTISAMPLE);
    glDisable(GL_SAMPLE_MASK);
    glDisable(GL_SAMPLE_ALPHA_TO_ONE);
  }
#endif
  // Alpha is spent on coverage. What the buffer's alpha keeps instead is whether a sample shows the
  // background, 1, or a face, 0: blending with factors that are constant.
  const glm::vec4 empty(glm::vec3(background) * background.a, 1.0f);
  glClearBufferfv(GL_COLOR, 0, &empty[0]);
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_ONE, GL_ZERO, GL_ZERO, GL_ZERO);
}

void CoverageTarget::resolve_to(GLuint framebuffer, const glm::vec4& background) {
  gl::use_plain_rasterisation(size_.width, size_.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_framebuffer_.id());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_framebuffer_.id());
  glBlitFramebuffer(0, 0, size_.width, size_.height, 0, 0, size_.width, size_.height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glDisable(GL_DEPTH_TEST);
  resolve_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, resolved_.id());
  gl::use_texture_sampling(0);
  resolve_.set("resolved", 0);
  resolve_.set("background", background);
  resolve_.set("background_depth", 0.0f);
  nothing_.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

void CoverageTarget::leave_context() {
  nothing_.forget();
  samples_framebuffer_ = {};
  resolved_framebuffer_ = {};
}

}  // namespace tureen
