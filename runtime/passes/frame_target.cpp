#include "runtime/passes/frame_target.hpp"

#include <cassert>

#include "scene/triangle_soup.hpp"

namespace tureen {

namespace {

/// 0 is the background.
GLint stencil_of(std::size_t layer) { return static_cast<GLint>(layer) + 1; }

}  // namespace

const TargetFormat& FrameTarget::depth_format() const {
  if (format_.layered)
    return format_.reversed_depth ? target_formats::depth32f_stencil
                                  : target_formats::depth24_stencil;
  return format_.reversed_depth ? target_formats::depth32f : target_formats::depth24;
}

void FrameTarget::resize(glm::ivec2 size) {
  color_ = format_.image_store ? make_image_target(target_formats::rgba8, size.x, size.y)
                               : make_target(target_formats::rgba8, size.x, size.y);
  depth_ = make_target(depth_format(), size.x, size.y);
  color_framebuffer_ = make_framebuffer({color_.id()}, depth_attachment());
  if (format_.visibility) {
    visible_ = make_target(target_formats::rg32ui, size.x, size.y);
    visibility_framebuffer_ = make_framebuffer({visible_.id()}, depth_attachment());
  } else {
    visible_ = {};
    visibility_framebuffer_ = {};
  }
  size_ = size;
  gl::check("FrameTarget");
}

std::size_t FrameTarget::bytes() const {
  return bytes_of(target_formats::rgba8, size_) + bytes_of(depth_format(), size_) +
         (format_.visibility ? bytes_of(target_formats::rg32ui, size_) : 0);
}

void FrameTarget::begin(const glm::vec4& background) {
  background_ = background;
  visibility_drawn_ = depth_drawn_ = color_drawn_ = false;
}

void FrameTarget::draw_visibility(std::size_t layer) {
  assert(format_.visibility);
  glBindFramebuffer(GL_FRAMEBUFFER, visibility_framebuffer_.id());
  if (!visibility_drawn_) {
    const GLuint empty[4] = {no_face, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, empty);
    visibility_drawn_ = true;
  }
  use_depth();
  if (!format_.layered) return;
  glEnable(GL_STENCIL_TEST);
  glStencilMask(0xff);
  glStencilFunc(GL_ALWAYS, stencil_of(layer), 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
}

void FrameTarget::draw_color() {
  glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer_.id());
  if (!color_drawn_) glClearBufferfv(GL_COLOR, 0, &background_[0]);
  color_drawn_ = true;
  use_depth();
}

void FrameTarget::end() {
  if (!color_drawn_) draw_color();
}

void FrameTarget::draw_samples_of(std::size_t layer) {
  draw_color();
  glDepthMask(GL_FALSE);
  if (format_.layered) {
    glDepthFunc(GL_ALWAYS);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_EQUAL, stencil_of(layer), 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  } else {
    // The triangle passes exactly where something nearer than the cleared depth was drawn.
    glDepthFunc(format_.reversed_depth ? GL_LESS : GL_GREATER);
  }
}

void FrameTarget::overwrite_color() {
  glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer_.id());
  glDisable(GL_DEPTH_TEST);
  color_drawn_ = true;
}

void FrameTarget::use_depth() {
  glDepthFunc(nearer());
  if (depth_drawn_) return;
  const float far = far_depth();
  if (format_.layered) {
    glStencilMask(0xff);
    glClearBufferfi(GL_DEPTH_STENCIL, 0, far, 0);
  } else {
    glClearBufferfv(GL_DEPTH, 0, &far);
  }
  depth_drawn_ = true;
}

void FrameTarget::bind_visibility(const gl::Program& program, int unit) const {
  program.set_texture("visible", unit, visible_.id());
}

glm::dmat4 FrameTarget::clip_from_view(const Camera& camera, const ClipRange& range) const {
  return format_.reversed_depth ? clip_from_view_reversed(camera, range.near)
                                : tureen::clip_from_view(camera, range.near, range.far);
}

void FrameTarget::leave_context() {
  visibility_framebuffer_ = {};
  color_framebuffer_ = {};
}

}  // namespace tureen
