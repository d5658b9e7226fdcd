// Draws the splats of all layers over the frame's soups without blending and without an order: a
// fragment of alpha a is drawn opaque with probability a, and the depth test keeps the nearest
// (stochastic transparency, doi 10.1145/1730804.1730830). Depth is that of the splat's centre, so
// the mean of many samples is the image that blending in the order of the centres gives.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/device_splats.hpp"
#include "runtime/splats/splat_target.hpp"

namespace tureen {

class StochasticSplatPass final : public SplatBlendingPass {
 public:
  /// `layers` outlive the pass; at least one.
  StochasticSplatPass(const gl::Capabilities& device, std::span<DeviceSplats* const> layers,
                      SplatFormat format);

  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t target_bytes() const override;
  void leave_context() override;

  std::vector<glm::vec4> read_blended() override;

 private:
  std::vector<DeviceSplats*> layers_;
  BlendFormat format_;
  SplatTarget sampled_;
  gl::Texture depth_;  // of the centres
  gl::Framebuffer framebuffer_, with_depth_of_soups_;
};

}  // namespace tureen
