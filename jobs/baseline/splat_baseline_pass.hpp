// The pass of the plain baseline for splats: an instanced quad a splat, everything of a splat
// computed at each of its four vertices, blended back to front in 8 bits in the order of
// SplatBaselineOrder. It reads only the stored values of the splats.
#pragma once

#include <optional>

#include "jobs/baseline/splat_baseline_order.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/splat_source.hpp"
#include "runtime/splats/splat_target.hpp"

namespace tureen {

class SplatBaselinePass final : public Pass {
 public:
  /// `source` has three texels a splat: of windows those of prepare_splats(), of Gaussians centre,
  /// covariance and opacity. The plan is from make_baseline_plan(). Throws DeviceLimitError.
  SplatBaselinePass(const gl::Capabilities& device, const SplatSource& source,
                    const SplatPlan& plan);

  const char* name() const override { return "splats"; }
  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t device_bytes() const override;
  std::size_t target_bytes() const override { return transparent_ ? transparent_->bytes() : 0; }
  void leave_context() override;

 private:
  void order_splats(const FrameCamera& camera);
  void set_view(const Frame& frame);

  gl::Capabilities device_;
  SplatProfile profile_;
  std::vector<glm::vec3> centers_;
  TexelStore kernel_, coefficients_;
  gl::Program program_;
  SplatBaselineOrder order_;
  gl::Buffer splats_;  // the order, as an attribute of the instances
  gl::LocalVertexArray vertex_array_;
  glm::ivec2 size_{0};
  std::optional<SplatTarget> transparent_;  // for a background that is not opaque
  gl::Framebuffer transparent_framebuffer_;
};

}  // namespace tureen
