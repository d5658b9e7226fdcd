// The image at rest (Renderer::refine()): the mean of frames whose sample positions form a regular
// grid in each pixel. It is filtered as by FilterPass, from the same positions as supersampling.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/full_screen.hpp"

namespace tureen {

/// Samples a pixel at rest along each axis, or more: the largest Quality::supersampling.
inline constexpr int samples_at_rest = 8;

/// Number of frames at rest, for frames of `supersampling` x `supersampling` samples per pixel: 64,
/// 16 or 4, so that the pixel has at least 8 x 8 samples. 0 if one frame has them.
int frames_at_rest(int supersampling);

/// The sample position of frame `index` (from 0) relative to a pixel's own, in pixels to the right
/// and down. The mean of each four positions from a multiple of 4 is 0, so the image does not shift
/// while frames are added.
glm::dvec2 position_at_rest(int index, int supersampling);

class Accumulation {
 public:
  explicit Accumulation(gl::Api api);

  /// Starts without frames; image_framebuffer() then has the colours of `framebuffer`, of this
  /// size, RGBA8. `frames`: the number of frames of the mean, a multiple of 4. Requires
  /// Capabilities::float_targets. Throws DeviceLimitError.
  void begin(glm::ivec2 size, GLuint framebuffer, int frames);
  /// Adds a frame of the same size: a texture of RGBA8. `background`: the colour of pixels that are
  /// transparent in all frames. After every fourth frame, the image becomes the mean of all. The
  /// last one frees the sums.
  void add(GLuint image, const glm::vec4& background);

  /// Back to no frames. Frees the sums.
  void forget();

  int frames() const { return added_; }
  bool complete() const { return added_ > 0 && added_ == wanted_; }
  /// RGBA8.
  GLuint image_framebuffer() const { return image_framebuffer_.id(); }
  /// Bytes of the textures, by their formats.
  std::size_t bytes() const;

 private:
  void free_sums();

  gl::Program adding_, dividing_;
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  int added_ = 0, wanted_ = 0;
  gl::Texture image_;
  gl::Framebuffer image_framebuffer_;
  // Colours times alpha, and alpha. Each frame reads one and writes the other, because not every
  // device blends in 32-bit floats.
  gl::Texture sums_[2];
  gl::Framebuffer sum_framebuffers_[2];
};

}  // namespace tureen
