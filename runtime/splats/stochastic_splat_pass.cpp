#include "runtime/splats/stochastic_splat_pass.hpp"

#include <algorithm>

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

constexpr TargetFormat depth_format = target_formats::depth32f;

/// Nothing is blended, so fractions of 16 bits lose no faint splat: alpha is 0 or 1.
BlendFormat format_for(SplatFormat requested, const gl::Capabilities& device,
                       std::span<DeviceSplats* const> layers) {
  float largest_color = 1;
  for (const DeviceSplats* layer : layers)
    largest_color = std::max(largest_color, layer->largest_color());
  return blend_format(requested, device, 1.0f, largest_color);
}

}  // namespace

StochasticSplatPass::StochasticSplatPass(const gl::Capabilities& device,
                                         std::span<DeviceSplats* const> layers, SplatFormat format)
    : layers_(layers.begin(), layers.end()),
      format_(format_for(format, device, layers_)),
      sampled_(device.api, format_) {}

void StochasticSplatPass::resize(const FrameTarget& target) {
  sampled_.resize(target.size());
  depth_ = make_target(depth_format, target.size().x, target.size().y);
  framebuffer_ = make_framebuffer({sampled_.texture()}, {depth_.id()});
  with_depth_of_soups_ = make_framebuffer({sampled_.texture()}, target.depth_attachment());
}

void StochasticSplatPass::draw(const Frame& frame, FrameTarget& target) {
  for (DeviceSplats* layer : layers_)
    if (frame.layers[layer->layer()].visible) layer->project(frame, format_.color_unit);
  gl::use_plain_rasterisation(target.size().x, target.size().y);
  // The fragments compare their depth with that of the soups. Without soups, this clears it.
  glBindFramebuffer(GL_FRAMEBUFFER, with_depth_of_soups_.id());
  target.use_depth();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  const glm::vec4 transparent(0.0f);
  const float farthest = 0;
  glClearBufferfv(GL_COLOR, 0, &transparent[0]);
  glClearBufferfv(GL_DEPTH, 0, &farthest);
  glDepthFunc(GL_GREATER);
  for (DeviceSplats* layer : layers_) {
    if (!frame.layers[layer->layer()].visible || layer->centers().empty()) continue;
    layer->begin_runs(frame, target, 0, {.output = SplatOutput::sample});
    layer->draw_run(0, static_cast<std::uint32_t>(layer->centers().size()));
  }
  sampled_.composite_over(target);
}

std::vector<glm::vec4> StochasticSplatPass::read_blended() { return sampled_.read(framebuffer_); }

std::size_t StochasticSplatPass::target_bytes() const {
  return sampled_.bytes() + bytes_of(depth_format, sampled_.size());
}

void StochasticSplatPass::leave_context() {
  sampled_.leave_context();
  framebuffer_ = {};
  with_depth_of_soups_ = {};
  depth_ = {};
}

}  // namespace tureen
