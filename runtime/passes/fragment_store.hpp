// The result of the geometry pass of a deferred frame, input to the shading pass: for each pixel
// the visible face and the point on it, (slot, barycentrics) as RG32UI.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/gl/objects.hpp"
#include "runtime/gl/program.hpp"

namespace tureen {

class FragmentStore {
 public:
  /// An empty store.
  FragmentStore() = default;
  /// A target of this size with a depth texture. Throws DeviceLimitError as make_framebuffer.
  FragmentStore(int width, int height, GLuint depth);

  /// Binds it as the render target and clears all pixels to no face.
  void begin() const;
  /// For the shading pass: binds the target to a unit and sets the sampler `visible` of `program`,
  /// which is in use.
  void bind(const gl::Program& program, int unit) const;

  /// Bytes of a target of this size, without the depth texture.
  static std::size_t bytes(glm::ivec2 size);

  GLuint framebuffer() const { return framebuffer_.id(); }

 private:
  gl::Texture visible_;
  gl::Framebuffer framebuffer_;
};

}  // namespace tureen
