#include "runtime/splats/splat_pass.hpp"

#include "runtime/gl/state.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

SplatPass::SplatPass(const gl::Capabilities& device,
                     std::span<const std::unique_ptr<DeviceSplats>> layers, Precision precision,
                     float fraction)
    : precision_(precision),
      splats_(layers, fraction),
      resolve_(assemble({.file = "full_screen.vert"}, device.api),
               assemble({.file = "splat_resolve.frag"}, device.api)) {}

const TargetFormat& SplatPass::blended_format() const {
  return precision_ == Precision::single ? target_formats::rgba32f : target_formats::rgba16f;
}

void SplatPass::resize(const FrameTarget& target) {
  size_ = target.size();
  blended_ = make_target(blended_format(), size_.x, size_.y);
  behind_ = make_target(target_formats::rgba8, size_.x, size_.y);
  blended_framebuffers_ = make_splat_framebuffers({blended_.id()}, target);
  behind_framebuffer_ = make_framebuffer({behind_.id()});
}

void SplatPass::draw(const Frame& frame, FrameTarget& target) {
  splats_.prepare(frame);
  blend(frame, target);
  resolve(target);
}

void SplatPass::blend(const Frame& frame, FrameTarget& target) {
  begin_splats(target, blended_framebuffers_, glm::vec4(0.0f));
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  splats_.draw(frame, target, blended_framebuffers_);
  glDisable(GL_BLEND);
}

void SplatPass::resolve(FrameTarget& target) {
  target.draw_color();  // clears the colours if no pass has drawn any
  blit_color(target.color_framebuffer(), behind_framebuffer_.id(), size_);
  target.overwrite_color();
  resolve_.use();
  resolve_.set_texture("splats", 0, blended_.id());
  resolve_.set_texture("behind", 1, behind_.id());
  full_screen_.draw(resolve_);
}

std::vector<glm::vec4> SplatPass::read_blended() const {
  return read_float_pixels(blended_framebuffers_.with_depth.id(), size_);
}

std::size_t SplatPass::target_bytes() const {
  return bytes_of(blended_format(), size_) + bytes_of(target_formats::rgba8, size_);
}

void SplatPass::leave_context() {
  full_screen_.leave_context();
  blended_framebuffers_ = {};
  behind_framebuffer_ = {};
}

}  // namespace tureen
