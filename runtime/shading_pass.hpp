// The second pass of a deferred frame: colours for the covered pixels, by a triangle over the whole
// window or, where the plan names faces and the device can, by a compute shader; whichever is
// faster, where the plan leaves it to measurement.
#pragma once

#include <optional>
#include <string>

#include "runtime/choose_shading_stage.hpp"
#include "runtime/device_appearance.hpp"
#include "runtime/fragment_store.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/gl/timer_query.hpp"
#include "runtime/pipeline.hpp"

namespace tureen {

/// Complete GLSL; what the plan's shading stage does not need is empty.
struct ShadingSources {
  std::string vertex, fragment, compute;
};

/// How many invocations wide and high a work group is: GROUP_SIDE of shading.comp.
inline constexpr int shading_group_side = 8;

class ShadingPass {
 public:
  /// `plan` must outlive it.
  ShadingPass(const RenderPlan& plan, const ShadingSources& sources);

  /// What a frame is made of. The stored fragments, the depth and the colours have the same size.
  struct Frame {
    const FrameCamera& camera;
    const glm::vec4& background;
    const FragmentStore& store;
    const DeviceAppearance& appearance;
    GLuint color_framebuffer,
        color_texture;  // of that texture, and the depth the store was made of
    int width, height;
  };

  /// Colours `frame`. Where the stage is to be measured, does so in the first frame, and again when
  /// a frame has four times as many pixels, or as few, as the one it was measured in.
  void draw(const Frame& frame, gl::PassTimer* timer);

  /// See Renderer::leave_context().
  void leave_context() { nothing_.forget(); }

  /// Nothing where the plan is told the stage, and before the first frame.
  const std::optional<StageChoice>& choice() const { return choice_; }

 private:
  void draw(const Frame& frame, ShadingStage stage);
  void draw_fragments(const Frame& frame);
  void compute(const Frame& frame) const;
  void set_uniforms(const gl::Program& program, const Frame& frame) const;
  bool must_measure(const Frame& frame) const;

  const RenderPlan& plan_;
  gl::Program fragment_, compute_;
  gl::LocalVertexArray nothing_;
  std::optional<StageChoice> choice_;
  double measured_pixels_ = 0;
};

}  // namespace tureen
