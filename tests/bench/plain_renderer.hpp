// A minimal renderer, the baseline for large opaque soups: unshared vertices of 16 bytes (three
// floats and a colour), in file order, one draw call, one matrix.
#pragma once

#include "image/image.hpp"
#include "runtime/gl/objects.hpp"
#include "runtime/gl/program.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen::test {

class PlainRenderer {
 public:
  /// For a soup with FaceColors. The context must be current, here and for every call.
  explicit PlainRenderer(const TriangleSoup& soup);

  /// Draws into a separate target, on black, with an ordinary 24-bit depth buffer.
  void draw(const Camera& camera);
  /// The last image, rows from the top.
  Image8 read_color() const;

 private:
  void resize(int width, int height);

  Bounds bounds_;
  GLsizei vertex_count_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
  gl::Program program_;
  gl::Texture color_, depth_;
  gl::Framebuffer framebuffer_;
  int width_ = 0, height_ = 0;
};

}  // namespace tureen::test
