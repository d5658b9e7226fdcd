// Blends the splats of all layers over the frame's soups: projects them, orders them, blends them
// front to back under the soups' depth, and composites the result over the frame's colours. They
// are blended in chunks: each skips the splats that earlier chunks hide.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/hidden_tiles.hpp"
#include "runtime/splats/ordered_splats.hpp"
#include "runtime/splats/splat_target.hpp"

namespace tureen {

class SplatPass final : public SplatBlendingPass {
 public:
  /// `layers` outlive the pass; at least one. `fraction`: of the splats that are drawn.
  SplatPass(const gl::Capabilities& device, std::span<DeviceSplats* const> layers,
            SplatFormat format, float fraction = 1);

  /// For sort_with() and in_order().
  OrderedSplats& splats() { return splats_; }

  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t device_bytes() const override { return splats_.device_bytes(); }
  std::size_t target_bytes() const override;
  void leave_context() override;

  std::vector<glm::vec4> read_blended() override;

 private:
  OrderedSplats splats_;
  BlendFormat format_;
  SplatTarget blended_;
  SplatFramebuffers framebuffers_;
  std::optional<HiddenTiles> hidden_;  // if the device draws in chunks
};

}  // namespace tureen
