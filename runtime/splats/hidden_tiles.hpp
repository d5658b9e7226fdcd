// The tiles of the image in which the splats blended so far hide all later ones: where every
// pixel's transmittance has fallen so far that nothing behind changes its colour by half an 8-bit
// step. Vertex shaders skip the splats whose box has only hidden tiles (splat_hidden.glsl).
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/full_screen.hpp"

namespace tureen {

class HiddenTiles {
 public:
  /// Of the finest tiles, in pixels. Each further level has tiles of twice the side, so the
  /// coarsest have 128 pixels. Splats larger than three of these are drawn untested.
  static constexpr int side = 8;
  static constexpr int levels = 5;

  /// No splat has a larger colour than `largest_color`.
  HiddenTiles(gl::Api api, float largest_color);

  /// For images of this size. Throws DeviceLimitError.
  void resize(glm::ivec2 size);
  /// Finds the hidden tiles of a texture with blended splats. Changes the framebuffer, the viewport
  /// and the tests.
  void find(GLuint blended);
  /// R8 with mipmaps: 1 where a tile is hidden.
  GLuint texture() const { return tiles_.id(); }

  std::size_t bytes() const;
  /// See Renderer::leave_context(). resize() must follow.
  void leave_context();

 private:
  glm::ivec2 size_of(int level) const;

  float min_alpha_;  // of a hidden pixel
  gl::Program from_pixels_, from_tiles_;
  FullScreen full_screen_;
  glm::ivec2 size_{0}, tile_count_{0};  // of the image; of the finest level
  gl::Texture tiles_;
  std::vector<gl::Framebuffer> framebuffers_;  // of the levels
};

}  // namespace tureen
