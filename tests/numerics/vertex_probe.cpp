#include "tests/numerics/vertex_probe.hpp"

#include "runtime/gl/api.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/shader_source.hpp"
#include "tests/numerics/scenes.hpp"

namespace tureen::test {

std::vector<glm::vec4> clip_positions(const FrameCamera& frame, const glm::dmat4& clip_from_view,
                                      const std::vector<glm::vec3>& positions) {
  const gl::Api api = shared_context().capabilities().api;
  const gl::Program program(assemble({.file = "geometry.vert"}, api),
                            assemble({.file = "nothing.frag"}, api));
  program.use();
  GLint id = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &id);
  // Linking determines which outputs are captured.
  const char* captured = "gl_Position";
  glTransformFeedbackVaryings(GLuint(id), 1, &captured, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(GLuint(id));
  program.use();
  Geometry::set_camera(program, frame, clip_from_view);

  const gl::VertexArray array = gl::VertexArray::create();
  const gl::Buffer from = gl::Buffer::create(), to = gl::Buffer::create();
  glBindVertexArray(array.id());
  glBindBuffer(GL_ARRAY_BUFFER, from.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(positions.size() * sizeof positions[0]),
               positions.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof positions[0], nullptr);
  std::vector<glm::vec4> result(positions.size());
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, to.id());
  glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, GLsizeiptr(result.size() * sizeof result[0]), nullptr,
               GL_STREAM_READ);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, GLsizei(positions.size()));
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, GLsizeiptr(result.size() * sizeof result[0]),
                     result.data());
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
  return result;
}

}  // namespace tureen::test
