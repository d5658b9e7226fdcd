// Measures the splats of a frame and the soups behind them, and draws the measured values or the
// colours of a debug view.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/debug_views/debug_view_passes.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/splat_measures.hpp"

namespace tureen {

class MeasurePass final : public Pass {
 public:
  struct Inputs {
    const gl::Capabilities& device;
    std::span<DeviceSplats* const> splats;
    std::span<const DebugViewSubject> subjects;  // for each layer
    ShownDebugView& shown;
    /// Of the soups; null without soups. Only DebugView::overdraw reads it.
    const FragmentCountPass* counts = nullptr;
    /// Makes the passes that draw the normals and depths of the soups into `surface`.
    std::function<Passes(const gl::Framebuffer& surface)> make_surfaces = {};
  };
  /// The references of `inputs` outlive the pass. Passes before it have drawn the soups' depth.
  explicit MeasurePass(const Inputs& inputs);

  const char* name() const override { return "measures"; }
  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t device_bytes() const override;
  std::size_t target_bytes() const override;
  void leave_context() override;

  /// DebugViews::read_values().
  std::vector<glm::vec4> read_values() const;

 private:
  void draw_surfaces(const Frame& frame, FrameTarget& target);
  void show(const Frame& frame, FrameTarget& target);

  std::span<const DebugViewSubject> subjects_;
  ShownDebugView& shown_;
  const FragmentCountPass* counts_;
  std::optional<SplatMeasures> measures_;  // if there are splats
  Passes surfaces_;                        // of the soups
  gl::Program program_;
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  gl::Texture surface_, values_;
  gl::Framebuffer surface_framebuffer_, values_framebuffer_;
};

}  // namespace tureen
