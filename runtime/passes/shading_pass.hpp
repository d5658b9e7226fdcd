// The second pass of a deferred frame: colours for the covered pixels, by a triangle over the whole
// window or, if the plan requests it, by a compute shader.
#pragma once

#include <string>

#include "runtime/gl/program.hpp"
#include "runtime/gl/timer_query.hpp"
#include "runtime/passes/device_appearance.hpp"
#include "runtime/passes/fragment_store.hpp"
#include "runtime/passes/pipeline.hpp"

namespace tureen {

/// Complete GLSL; sources that the plan's shading stage does not need are empty.
struct ShadingSources {
  std::string vertex, fragment, compute;
};

/// Width and height of a work group in invocations: GROUP_SIDE of shading.comp.
inline constexpr int shading_group_side = 8;

class ShadingPass {
 public:
  /// `plan` must outlive this object.
  ShadingPass(const RenderPlan& plan, const ShadingSources& sources);

  /// The data of a frame. The stored fragments, the depth and the colours have the same size.
  struct Frame {
    const FrameCamera& camera;
    const glm::vec4& background;
    const FragmentStore& store;
    const DeviceAppearance& appearance;
    GLuint color_framebuffer,
        color_texture;  // the texture of color_framebuffer, which shares the depth of `store`
    int width, height;
  };

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
