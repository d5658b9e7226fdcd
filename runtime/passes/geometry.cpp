#include "runtime/passes/geometry.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "runtime/gl/allocation.hpp"

namespace tureen {

Geometry::Geometry(const GeometrySource& source)
    : positions_(gl::Buffer::create()), device_bytes_(source.face_count * sizeof(FaceCorners)) {
  // GL counts vertices in 31 bits.
  constexpr std::size_t max_faces = 0x7fffffff / 3;
  if (source.face_count > max_faces)
    throw DeviceLimitError(std::to_string(source.face_count) + " triangles are more than the " +
                           std::to_string(max_faces) + " that OpenGL draws from one buffer");
  glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
  if (gl::is_refused([&] {
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(device_bytes_), nullptr,
                     GL_STATIC_DRAW);
      }))
    throw DeviceLimitError(std::to_string(source.face_count) + " triangles need a buffer of " +
                           std::to_string(device_bytes_ >> 20) + " MiB, which the device refuses");
  // In blocks, so that the second copy stays small.
  constexpr std::size_t block_faces = 32768;
  std::vector<FaceCorners> block;
  for (std::size_t first = 0; first < source.face_count; first += block_faces) {
    block.resize(std::min(block_faces, source.face_count - first));
    source.fill(first, block);
    glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(first * sizeof block[0]),
                    static_cast<GLsizeiptr>(block.size() * sizeof block[0]), block.data());
  }
  gl::check("Geometry");
}

void Geometry::bind() {
  if (!vertex_array_.bind()) return;
  glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
}

void Geometry::set_camera(const gl::Program& program, const FrameCamera& frame,
                          const glm::dmat4& clip_from_view) {
  set_eye(program, frame.eye);
  const glm::dmat4 rotation(glm::dmat3(frame.camera.view_from_world));
  program.set("clip_from_camera", glm::mat4(clip_from_view * rotation));
}

void set_eye(const gl::Program& program, glm::dvec3 eye) {
  const glm::vec3 high(eye);
  program.set("eye_high", high);
  program.set("eye_low", glm::vec3(eye - glm::dvec3(high)));
}

void set_rays(const gl::Program& program, const Camera& camera) {
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const glm::dvec3 per_column = axes[0] / camera.fx;
  const glm::dvec3 per_row = axes[1] / camera.fy;
  const glm::dvec3 at_corner =
      -axes[2] - camera.cx * per_column - (camera.height - camera.cy) * per_row;
  program.set("ray_at_corner", glm::vec3(at_corner));
  program.set("ray_per_column", glm::vec3(per_column));
  program.set("ray_per_row", glm::vec3(per_row));
}

}  // namespace tureen
