// A method of rendering a planned soup to a target. Users include Renderer; a module outside
// runtime/ can implement a pipeline of its own and pass it to a Renderer (jobs/baseline).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>

#include "runtime/gl/context.hpp"
#include "runtime/gl/objects.hpp"
#include "runtime/gl/timer_query.hpp"
#include "runtime/passes/appearance_source.hpp"
#include "runtime/passes/geometry_source.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/camera.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

/// One frame's camera, relative to the scene's origin.
struct FrameCamera {
  Camera camera;
  glm::dvec3 eye;  // relative to the origin
  ClipRange range;
};

class Pipeline {
 public:
  virtual ~Pipeline() = default;

  /// Creates the targets for this size. Called before the first frame and when the size changes.
  virtual void resize(int width, int height) = 0;
  virtual void draw(const FrameCamera& frame, const glm::vec4& background) = 0;

  /// The framebuffer with the final colours, RGBA8, row 0 at the bottom.
  virtual GLuint color_framebuffer() const = 0;
  /// The colours as a GL_TEXTURE_2D, nearest sampling.
  virtual GLuint color_texture() const = 0;
  /// The framebuffer with (slot, barycentrics) as RG32UI, of sample_size(), or 0 if the pipeline
  /// has none.
  virtual GLuint visibility_framebuffer() const { return 0; }
  /// The depth of the last frame, a GL_TEXTURE_2D of sample_size(), or 0 if it cannot be sampled.
  virtual GLuint depth_texture() const { return 0; }
  /// Width and height at which triangles are rasterised: the image's size, except for resampling
  /// pipelines.
  virtual glm::ivec2 sample_size() const = 0;
  /// Bytes of the scene's buffers and textures, without the targets.
  virtual std::size_t device_bytes() const = 0;
  /// Bytes of the targets that resize() created, from pixel count and format.
  virtual std::size_t target_bytes() const = 0;

  /// See Renderer::leave_context(). The caller calls resize() before the next draw().
  virtual void leave_context() = 0;

  /// Later frames report their passes to this timer; null disables the times. The timer must
  /// outlive these frames.
  virtual void time_passes(gl::PassTimer* timer) { timer_ = timer; }

 protected:
  gl::PassTimer* timer_ = nullptr;
};

/// The plan must outlive the pipeline; the sources are read and not needed afterwards.
std::unique_ptr<Pipeline> make_tureen_pipeline(const gl::Capabilities& capabilities,
                                               AppearanceSource appearance,
                                               const GeometrySource& geometry,
                                               const RenderPlan& plan);

}  // namespace tureen
