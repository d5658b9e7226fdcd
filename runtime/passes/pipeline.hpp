// A way to turn a planned soup into pixels of a target. Internal to runtime/: users want Renderer.
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

/// One frame's camera, relative to the soup's origin.
struct FrameCamera {
  Camera camera;
  glm::dvec3 eye;  // relative to the origin
  ClipRange range;
};

class Pipeline {
 public:
  virtual ~Pipeline() = default;

  /// Makes the targets for this size. Called before the first frame and when the size changes.
  virtual void resize(int width, int height) = 0;
  virtual void draw(const FrameCamera& frame, const glm::vec4& background) = 0;

  /// The framebuffer with the finished colours, RGBA8, row 0 at the bottom.
  virtual GLuint color_framebuffer() const = 0;
  /// What it draws into: a GL_TEXTURE_2D, nearest sampling.
  virtual GLuint color_texture() const = 0;
  /// The framebuffer with (slot, barycentrics) as RG32UI, or 0 where the pipeline has none; of
  /// sample_size().
  virtual GLuint visibility_framebuffer() const { return 0; }
  /// The depth of the last frame, a GL_TEXTURE_2D of sample_size(), or 0 where it cannot be
  /// sampled.
  virtual GLuint depth_texture() const { return 0; }
  /// How many samples wide and high the geometry is drawn: the picture's own size but for pipelines
  /// that resample.
  virtual glm::ivec2 sample_size() const = 0;
  /// Buffers and textures of the scene, not the targets.
  virtual std::size_t device_bytes() const = 0;
  /// The targets that resize() made, by the sizes of their formats.
  virtual std::size_t target_bytes() const = 0;

  /// See Renderer::leave_context(). resize() comes before the next draw().
  virtual void leave_context() = 0;

  /// Later frames tell their passes to this timer, or to none. It must outlive them.
  virtual void time_passes(gl::PassTimer* timer) { timer_ = timer; }

 protected:
  gl::PassTimer* timer_ = nullptr;
};

/// The plan must outlive the pipeline; the sources are read and not needed afterwards.
std::unique_ptr<Pipeline> make_tureen_pipeline(const gl::Capabilities& capabilities,
                                               AppearanceSource appearance,
                                               const GeometrySource& geometry,
                                               const RenderPlan& plan);
std::unique_ptr<Pipeline> make_published_pipeline(const gl::Capabilities& capabilities,
                                                  const DeviceLimits& limits,
                                                  const TriangleSoup& soup, const RenderPlan& plan);

}  // namespace tureen
