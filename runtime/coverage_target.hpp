// A multisampled target for alpha to coverage: a fragment covers as many of a pixel's samples as
// its alpha says, and the picture is their mean. n samples round alpha to 1/n
// (docs/tradeoff.md).
#pragma once

#include <glm/vec4.hpp>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"

namespace tureen {

/// A multisampled buffer that is drawn into and never read.
struct RenderbufferTraits {
  static GLuint create() {
    GLuint id;
    glGenRenderbuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteRenderbuffers(1, &id); }
};
using Renderbuffer = gl::Object<RenderbufferTraits>;

class CoverageTarget {
 public:
  explicit CoverageTarget(gl::Api api);

  struct Size {
    int width, height;
    int samples;  // a pixel, one of Capabilities::sample_counts
    GLenum depth_format;
  };
  /// Throws DeviceLimitError as make_framebuffer does.
  void resize(const Size& size);

  /// Makes this the target, all background, and lets the alpha of fragments say how much they
  /// cover. Depth is the caller's to clear. What somebody else set of sample masks is undone.
  void begin(const glm::vec4& background) const;

  /// Draws the mean of each pixel's samples over all of `framebuffer`, of the same size, and leaves
  /// plain rasterisation behind. Only where the background is not opaque, colours over it are kept
  /// with 8 bits times alpha.
  void resolve_to(GLuint framebuffer, const glm::vec4& background);

  /// See Renderer::leave_context().
  void leave_context();

 private:
  gl::Api api_;
  gl::Program resolve_;
  gl::LocalVertexArray nothing_;
  Size size_{};
  Renderbuffer color_, depth_;
  gl::Texture resolved_;
  gl::Framebuffer samples_framebuffer_, resolved_framebuffer_;
};

}  // namespace tureen
