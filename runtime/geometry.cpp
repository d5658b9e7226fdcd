#include "runtime/geometry.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "runtime/face_part.hpp"
#include "soup/error.hpp"

namespace tureen {

namespace {

struct Corner {
  glm::vec3 position;
  glm::vec2 barycentrics;
};

/// A point of a face, rounded to floats, with the barycentrics of where rounding has put it.
Corner corner_of_part(const std::array<glm::dvec3, 3>& face, glm::dvec2 at) {
  const glm::dvec3 u = face[0] - face[2], v = face[1] - face[2];
  const glm::vec3 position(face[2] + at.x * u + at.y * v);
  const glm::dvec3 w = glm::dvec3(position) - face[2];
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
  const double uw = glm::dot(u, w), vw = glm::dot(v, w);
  return {position, glm::dvec2(vv * uw - uv * vw, uu * vw - uv * uw) / (uu * vv - uv * uv)};
}

}  // namespace

Geometry::Geometry(const TriangleSoup& soup, std::span<const std::uint32_t> faces,
                   std::span<const FacePart> parts)
    : positions_(gl::Buffer::create()),
      first_part_(static_cast<std::uint32_t>(faces.size() - parts.size())) {
  device_bytes_ = faces.size() * 3 * sizeof(glm::vec3);
  // GL counts vertices in 31 bits.
  constexpr std::size_t most_faces = 0x7fffffff / 3;
  if (faces.size() > most_faces)
    throw DeviceLimitError(std::to_string(faces.size()) + " triangles are more than the " +
                           std::to_string(most_faces) + " that OpenGL draws from one buffer");
  glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
  while (glGetError() != GL_NO_ERROR) {
    // Somebody else's errors must not read as ours below.
  }
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(device_bytes_), nullptr, GL_STATIC_DRAW);
  if (glGetError() != GL_NO_ERROR)
    throw DeviceLimitError(std::to_string(faces.size()) + " triangles need a buffer of " +
                           std::to_string(device_bytes_ >> 20) + " MiB, which the device refuses");
  // In blocks, so that the second copy stays small.
  constexpr std::size_t block_faces = 32768;
  std::vector<std::array<glm::vec3, 3>> block;
  std::vector<glm::vec2> barycentrics;
  barycentrics.reserve(3 * parts.size());
  for (std::size_t first = 0; first < faces.size(); first += block_faces) {
    block.clear();
    for (std::size_t i = first; i < std::min(first + block_faces, faces.size()); ++i) {
      const glm::uvec3& t = soup.triangles[faces[i]];
      block.push_back({soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]});
      if (i < first_part_) continue;
      // The corners of a whole face are its vertices to the bit.
      const std::array<glm::dvec3, 3> face = {block.back()[0], block.back()[1], block.back()[2]};
      const FacePart& part = parts[i - first_part_];
      for (std::size_t k = 0; k < 3; ++k) {
        const Corner corner = corner_of_part(face, part[k]);
        const bool whole = part[k] == whole_face[k];
        if (!whole) block.back()[k] = corner.position;
        barycentrics.push_back(whole ? glm::vec2(part[k]) : corner.barycentrics);
      }
    }
    glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(first * sizeof block[0]),
                    static_cast<GLsizeiptr>(block.size() * sizeof block[0]), block.data());
  }
  if (!parts.empty()) upload_barycentrics(barycentrics);
  gl::check("Geometry");
}

void Geometry::upload_barycentrics(std::span<const glm::vec2> barycentrics) {
  barycentrics_ = gl::Buffer::create();
  device_bytes_ += barycentrics.size_bytes();
  glBindBuffer(GL_ARRAY_BUFFER, barycentrics_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(barycentrics.size_bytes()),
               barycentrics.data(), GL_STATIC_DRAW);
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
                        // An offset, as GL wants it.
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
