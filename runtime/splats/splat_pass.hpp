// Blends the splats of all layers over the frame's soups: projects them, orders them, blends them
// front to back into a float target under the soups' depth, and composites that target over the
// frame's colours.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/passes/targets.hpp"
#include "runtime/splats/device_splats.hpp"
#include "runtime/splats/splat_order.hpp"
#include "runtime/splats/splat_sorter.hpp"

namespace tureen {

class SplatPass final : public Pass {
 public:
  /// Of the floats in which colours are blended.
  enum class Precision { single, half };

  /// `layers` outlive the pass; null for layers without splats.
  SplatPass(const gl::Capabilities& device, std::span<const std::unique_ptr<DeviceSplats>> layers,
            Precision precision);
  ~SplatPass() override;

  /// `sorter` sorts for frames with Frame::may_use_earlier_order. It outlives the pass and serves
  /// no other one. Null: all frames are sorted as they are drawn.
  void sort_with(SplatSorter* sorter);
  /// Whether the last frame was drawn in the order of its own view.
  bool in_order() const { return in_order_; }

  const char* name() const override { return "splats"; }
  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t device_bytes() const override;
  std::size_t target_bytes() const override;
  void leave_context() override;

  /// The blended splats of the last frame, premultiplied RGBA, row 0 on top; colours may exceed 1.
  /// Waits for the device.
  std::vector<glm::vec4> read_blended() const;

 private:
  void update_order(const Frame& frame);
  void sort_now(std::vector<SplatsInView> views);
  void continue_sorting(const std::vector<SplatsInView>& views);
  void stop_sorting();
  void upload_order();
  void blend(const Frame& frame, FrameTarget& target);
  void resolve(FrameTarget& target);

  const TargetFormat& blended_format() const;

  Precision precision_;
  std::vector<DeviceSplats*> layers_;
  gl::Program resolve_;
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  gl::Texture blended_, behind_;
  gl::Framebuffer blended_framebuffer_, behind_framebuffer_;
  gl::Framebuffer depthless_framebuffer_;  // of the same colours

  SplatOrder order_;
  std::vector<SplatsInView> ordered_;  // the views of the order
  bool in_order_ = true;
  SplatSorter* sorter_ = nullptr;
  std::optional<std::vector<SplatsInView>> sorting_;  // the views of the sorter's order
  gl::Texture order_texture_;
  int order_rows_ = 0;
};

}  // namespace tureen
