// The last pass of a frame that is drawn with more or fewer samples than pixels: n x n samples a
// pixel are averaged (supersampling), or fewer samples are interpolated (resolution scale).
//
// Both filter visible colours, not stored ones: colours are weighted by alpha, so a transparent
// background does not affect the colour of edges.
#pragma once

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/pass.hpp"
#include "scene/quality.hpp"

namespace tureen {

/// The rendered size for an image of `size` pixels at `scale`, 0 < scale <= 1: rounded, at least 1.
int scaled_size(int size, double scale);

/// Columns and rows of samples for an image of this size.
glm::ivec2 sample_size(const Quality& quality, glm::ivec2 size);

/// Supersampling: the mean of n x n samples on a regular grid, as OracleOptions::supersampling
/// computes it. Resolution scale: bilinear interpolation between sample centres, edge to edge;
/// pixels beyond the outermost centres repeat those samples.
class FilterPass final : public Pass {
 public:
  /// The quality must not be one sample per pixel.
  FilterPass(const Quality& quality, gl::Api api);

  const char* name() const override { return "filter"; }
  /// Sets the size of the image; resize() of its samples follows.
  void set_image_size(glm::ivec2 size) { size_ = size; }
  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t target_bytes() const override;
  void leave_context() override;

  /// The filtered colours, RGBA8, and a framebuffer with them.
  GLuint texture() const { return color_.id(); }
  GLuint framebuffer() const { return framebuffer_.id(); }

 private:
  gl::Program program_;
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  gl::Texture color_;
  gl::Framebuffer framebuffer_;
};

}  // namespace tureen
