// The second pass of a deferred frame: colours for the covered pixels, by a triangle over the whole
// window or, where the plan asks for it, by a compute shader.
#pragma once

#include <string>

#include "runtime/gl/program.hpp"
#include "runtime/gl/timer_query.hpp"
#include "runtime/passes/device_appearance.hpp"
#include "runtime/passes/fragment_store.hpp"
#include "runtime/passes/pipeline.hpp"

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

  /// Colours `frame`.
  void draw(const Frame& frame, gl::PassTimer* timer);

  /// See Renderer::leave_context().
  void leave_context() { nothing_.forget(); }

 private:
  void draw_fragments(const Frame& frame);
  void compute(const Frame& frame) const;
  void set_uniforms(const Frame& frame) const;

  const RenderPlan& plan_;
  gl::Program program_;
  gl::LocalVertexArray nothing_;
};

}  // namespace tureen
