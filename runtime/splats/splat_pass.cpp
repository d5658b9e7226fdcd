#include "runtime/splats/splat_pass.hpp"

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

SplatPass::SplatPass(const gl::Capabilities& device,
                     std::span<const std::unique_ptr<DeviceSplats>> layers, Precision precision,
                     float fraction)
    : splats_(layers, fraction),
      blended_(device.api, precision == Precision::single ? target_formats::rgba32f
                                                          : target_formats::rgba16f) {}

void SplatPass::resize(const FrameTarget& target) {
  blended_.resize(target.size());
  framebuffers_ = make_splat_framebuffers({blended_.texture()}, target);
}

void SplatPass::draw(const Frame& frame, FrameTarget& target) {
  splats_.prepare(frame);
  begin_splats(target, framebuffers_, glm::vec4(0.0f));
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  splats_.draw(frame, target, framebuffers_);
  glDisable(GL_BLEND);
  blended_.composite_over(target);
}

std::vector<glm::vec4> SplatPass::read_blended() const {
  return read_float_pixels(framebuffers_.with_depth.id(), blended_.size());
}

std::size_t SplatPass::target_bytes() const { return blended_.bytes(); }

void SplatPass::leave_context() {
  blended_.leave_context();
  framebuffers_ = {};
}

}  // namespace tureen
