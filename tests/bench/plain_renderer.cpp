#include "tests/bench/plain_renderer.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"
#include "scene/clip_range.hpp"

namespace tureen::test {

namespace {

struct Vertex {
  glm::vec3 position;
  std::uint8_t color[4];
};
static_assert(sizeof(Vertex) == 16);

constexpr const char* vertex_shader = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
uniform mat4 clip_from_world;
out vec4 vertex_color;
void main() {
  vertex_color = color;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

constexpr const char* fragment_shader = R"(#version 330 core
in vec4 vertex_color;
layout(location = 0) out vec4 color;
void main() { color = vertex_color; }
)";

}  // namespace

PlainRenderer::PlainRenderer(const TriangleSoup& soup)
    : bounds_(bounds(soup)),
      vertex_count_(static_cast<GLsizei>(3 * soup.triangles.size())),
      vertex_array_(gl::VertexArray::create()),
      vertices_(gl::Buffer::create()),
      program_(vertex_shader, fragment_shader) {
  const auto& colors = std::get<FaceColors>(soup.appearance);
  std::vector<Vertex> vertices;
  vertices.reserve(3 * soup.triangles.size());
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      Vertex vertex{soup.positions[soup.triangles[t][k]], {}};
      for (int c = 0; c < 4; ++c)
        vertex.color[c] = static_cast<std::uint8_t>(std::lround(colors.rgba[t][c] * 255.0f));
      vertices.push_back(vertex);
    }
  glBindVertexArray(vertex_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
               vertices.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Vertex),
                        // An offset, as GL requires. NOLINTNEXTLINE(performance-no-int-to-ptr)
                        reinterpret_cast<const void*>(sizeof(glm::vec3)));
  glBindVertexArray(0);
}

void PlainRenderer::resize(int width, int height) {
  width_ = width;
  height_ = height;
  color_ = make_target(target_formats::rgba8, width, height);
  depth_ = make_target(target_formats::depth24, width, height);
  framebuffer_ = make_framebuffer({color_.id()}, {depth_.id()});
}

void PlainRenderer::draw(const Camera& camera) {
  if (camera.width != width_ || camera.height != height_) resize(camera.width, camera.height);
  gl::use_plain_rasterisation(width_, height_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  const float black[4] = {0, 0, 0, 1};
  const float far = 1.0f;
  glClearBufferfv(GL_COLOR, 0, black);
  glClearBufferfv(GL_DEPTH, 0, &far);
  glDepthFunc(GL_LESS);
  const ClipRange range =
      clip_range(bounds_, camera.eye(), forward_of(camera), DepthStorage::fixed_24);
  program_.use();
  program_.set("clip_from_world", glm::mat4(clip_from_view(camera, range.near, range.far) *
                                            glm::dmat4(camera.view_from_world)));
  glBindVertexArray(vertex_array_.id());
  glDrawArrays(GL_TRIANGLES, 0, vertex_count_);
}

Image8 PlainRenderer::read_color() const { return read_pixels(framebuffer_.id(), width_, height_); }

}  // namespace tureen::test
