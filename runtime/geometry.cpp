#include "runtime/geometry.hpp"

#include <algorithm>
#include <vector>

#include "runtime/gl/allocation.hpp"
#include "soup/error.hpp"

namespace tureen {

Geometry::Geometry(const GeometrySource& source)
    : positions_(gl::Buffer::create()),
      first_part_(static_cast<std::uint32_t>(source.face_count - source.part_count())) {
  device_bytes_ = source.face_count * sizeof(FaceCorners);
  // GL counts vertices in 31 bits.
  constexpr std::size_t most_faces = 0x7fffffff / 3;
  if (source.face_count > most_faces)
    throw DeviceLimitError(std::to_string(source.face_count) + " triangles are more than the " +
                           std::to_string(most_faces) + " that OpenGL draws from one buffer");
  glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
  allocate(device_bytes_, nullptr, std::to_string(source.face_count) + " triangles");
  // In blocks, so that the second copy stays small.
  constexpr std::size_t block_faces = 32768;
  std::vector<FaceCorners> block;
  for (std::size_t first = 0; first < source.face_count; first += block_faces) {
    block.resize(std::min(block_faces, source.face_count - first));
    source.fill(first, block);
    glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(first * sizeof block[0]),
                    static_cast<GLsizeiptr>(block.size() * sizeof block[0]), block.data());
  }
  if (source.part_count() > 0) upload_barycentrics(source.part_barycentrics);
  gl::check("Geometry");
}

void Geometry::allocate(std::size_t bytes, const void* contents, const std::string& what) {
  if (gl::is_refused([&] {
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), contents, GL_STATIC_DRAW);
      }))
    throw DeviceLimitError(what + " need a buffer of " + std::to_string(bytes >> 20) +
                           " MiB, which the device refuses");
}

void Geometry::upload_barycentrics(std::span<const glm::vec2> barycentrics) {
  barycentrics_ = gl::Buffer::create();
  device_bytes_ += barycentrics.size_bytes();
  glBindBuffer(GL_ARRAY_BUFFER, barycentrics_.id());
  allocate(barycentrics.size_bytes(), barycentrics.data(),
           std::to_string(barycentrics.size() / 3) + " parts of triangles");
}

void Geometry::bind() {
  if (!vertex_array_.bind()) return;
  glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
}

void Geometry::bind_parts() {
  if (!part_array_.bind()) return;
  glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3),
                        // An offset, as GL wants it. NOLINTNEXTLINE(performance-no-int-to-ptr)
                        reinterpret_cast<const void*>(3 * sizeof(glm::vec3) * first_part_));
  glBindBuffer(GL_ARRAY_BUFFER, barycentrics_.id());
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(glm::vec2), nullptr);
}

void Geometry::leave_context() {
  vertex_array_.forget();
  part_array_.forget();
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
