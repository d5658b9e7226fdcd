// Antialiasing while the camera moves (temporal antialiasing: Karis, High Quality Temporal
// Supersampling, SIGGRAPH 2014). Each frame has another sample position in its pixels, and is
// blended with the image before, where that shows the same points. A colour of the image before
// that lies outside those of a pixel's neighbourhood is moved into their range, or disappearing
// things would leave trails.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/full_screen.hpp"
#include "scene/camera.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

class Motion {
 public:
  explicit Motion(gl::Api api);

  /// The sample position of the next frame relative to a pixel's own, in pixels to the right and
  /// down.
  glm::dvec2 position() const;
  /// Blends a frame with the image before, which becomes the image. `color`: RGBA8; `camera`: its
  /// view, without position(). The first frame after forget() or of another size is the image.
  /// Throws DeviceLimitError.
  void add(GLuint color, GLuint depth, glm::ivec2 size, const Camera& camera,
           const ClipRange& range, DepthStorage storage);
  /// Forgets the image before.
  void forget() { before_.reset(); }

  GLuint image_framebuffer() const { return framebuffers_[newest_].id(); }
  std::size_t bytes() const;

 private:
  gl::Program program_;
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  int newest_ = 0;
  unsigned frames_ = 0;
  std::optional<Camera> before_;  // of the newest image
  gl::Texture images_[2];
  gl::Framebuffer framebuffers_[2];
};

}  // namespace tureen
