// Blends the splats of all layers over the frame's soups: projects them, orders them, blends them
// front to back into a float target under the soups' depth, and composites that target over the
// frame's colours.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/ordered_splats.hpp"
#include "runtime/splats/splat_target.hpp"

namespace tureen {

class SplatPass final : public SplatBlendingPass {
 public:
  /// Of the floats in which colours are blended.
  enum class Precision { single, half };

  /// `layers` outlive the pass; null for layers without splats. `fraction`: of the splats that are
  /// drawn.
  SplatPass(const gl::Capabilities& device, std::span<const std::unique_ptr<DeviceSplats>> layers,
            Precision precision, float fraction = 1);

  /// For sort_with() and in_order().
  OrderedSplats& splats() { return splats_; }

  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t device_bytes() const override { return splats_.device_bytes(); }
  std::size_t target_bytes() const override;
  void leave_context() override;

  std::vector<glm::vec4> read_blended() const override;

 private:
  OrderedSplats splats_;
  SplatTarget blended_;
  SplatFramebuffers framebuffers_;
};

}  // namespace tureen
