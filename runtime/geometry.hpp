// The corners of the planned faces on the device, three a slot, and the uniforms of geometry.vert.
#pragma once

#include <span>

#include "runtime/gl/program.hpp"
#include "runtime/pipeline.hpp"

namespace tureen {

class Geometry {
 public:
  /// Throws DeviceLimitError.
  Geometry(const TriangleSoup& soup, std::span<const std::uint32_t> faces);

  void bind() const { glBindVertexArray(vertex_array_.id()); }
  std::size_t device_bytes() const { return device_bytes_; }

  /// Sets the camera of `program`, in use. `clip_from_view` is one of soup/camera.hpp's.
  static void set_camera(const gl::Program& program, const FrameCamera& frame,
                         const glm::dmat4& clip_from_view);

 private:
  gl::VertexArray vertex_array_;
  gl::Buffer positions_;
  std::size_t device_bytes_ = 0;
};

/// Sets eye_high and eye_low: a double split into two floats, so that position - eye loses nothing
/// near the eye however far both are from the origin (specs 05, G3).
void set_eye(const gl::Program& program, glm::dvec3 eye);

}  // namespace tureen
