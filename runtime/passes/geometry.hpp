// The corners of the planned faces on the device, three a slot, and the uniforms of geometry.vert.
#pragma once

#include "runtime/gl/program.hpp"
#include "runtime/passes/geometry_source.hpp"
#include "runtime/passes/pass.hpp"

namespace tureen {

class Geometry {
 public:
  /// The source is not needed afterwards. Throws DeviceLimitError.
  explicit Geometry(const GeometrySource& source);

  /// Vertex 3 i is the first of slot i.
  void bind();
  /// See Renderer::leave_context().
  void leave_context() { vertex_array_.forget(); }
  std::size_t device_bytes() const { return device_bytes_; }

  /// Sets the camera of `program`, which is in use. `clip_from_view` is a matrix from
  /// scene/camera.hpp.
  static void set_camera(const gl::Program& program, const FrameCamera& frame,
                         const glm::dmat4& clip_from_view);

 private:
  gl::LocalVertexArray vertex_array_;
  gl::Buffer positions_;
  std::size_t device_bytes_ = 0;
};

/// Sets eye_high and eye_low: a double split into two floats. Thus position - eye stays exact near
/// the eye at any distance of both from the origin (docs/numerics.md, G3).
void set_eye(const gl::Program& program, glm::dvec3 eye);

/// Sets the uniforms of view_direction.glsl; window y points up, image y down.
void set_rays(const gl::Program& program, const Camera& camera);

}  // namespace tureen
