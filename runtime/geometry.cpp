#include "runtime/geometry.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "soup/error.hpp"

namespace tureen {

Geometry::Geometry(const TriangleSoup& soup, std::span<const std::uint32_t> faces)
    : vertex_array_(gl::VertexArray::create()), positions_(gl::Buffer::create()) {
  device_bytes_ = faces.size() * 3 * sizeof(glm::vec3);
  // GL counts vertices in 31 bits.
  constexpr std::size_t most_faces = 0x7fffffff / 3;
  if (faces.size() > most_faces)
    throw DeviceLimitError(std::to_string(faces.size()) + " triangles are more than the " +
                           std::to_string(most_faces) + " that OpenGL draws from one buffer");
  glBindVertexArray(vertex_array_.id());
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
  for (std::size_t first = 0; first < faces.size(); first += block_faces) {
    block.clear();
    for (std::size_t i = first; i < std::min(first + block_faces, faces.size()); ++i) {
      const glm::uvec3& t = soup.triangles[faces[i]];
      block.push_back({soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]});
    }
    glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(first * sizeof block[0]),
                    static_cast<GLsizeiptr>(block.size() * sizeof block[0]), block.data());
  }
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  glBindVertexArray(0);
  gl::check("Geometry");
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

}  // namespace tureen
