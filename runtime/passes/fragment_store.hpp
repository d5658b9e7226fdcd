// What the geometry pass of a deferred frame leaves a pixel for the shading pass to colour: the
// winning face and where on it, (slot, barycentrics) as RG32UI.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/gl/objects.hpp"
#include "runtime/gl/program.hpp"

namespace tureen {

class FragmentStore {
 public:
  /// Nothing is stored.
  FragmentStore() = default;
  /// A target of this size with a depth texture. Throws DeviceLimitError as make_framebuffer.
  FragmentStore(int width, int height, GLuint depth);

  /// Makes it the target that is drawn into, with no face in any pixel.
  void begin() const;
  /// For the shading pass: binds the target to a unit and sets the sampler `visible` of `program`,
  /// in use.
  void bind(const gl::Program& program, int unit) const;

  /// Bytes of such a target without the depth texture.
  static std::size_t bytes(glm::ivec2 size);

  GLuint framebuffer() const { return framebuffer_.id(); }

 private:
  gl::Texture visible_;
  gl::Framebuffer framebuffer_;
};

}  // namespace tureen
