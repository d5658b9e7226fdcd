// What the geometry pass of a deferred frame leaves a pixel for the shading pass to colour: the
// name of the winning fragment, or its features.
#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "runtime/gl/program.hpp"
#include "runtime/plan.hpp"

namespace tureen {

class FragmentStore {
 public:
  using FeatureStorage = RenderPreset::FeatureStorage;

  /// Nothing is stored.
  FragmentStore() = default;
  /// Targets of this size that share a depth texture. Throws DeviceLimitError as make_framebuffer.
  FragmentStore(FeatureStorage storage, int width, int height, GLuint depth);

  /// The shaders of the two passes.
  static const char* geometry_shader(FeatureStorage storage);
  static const char* shading_shader(FeatureStorage storage);

  /// Makes the targets those that are drawn into, and no fragment the winner where the storage can
  /// say so; where features are stored, the depth alone tells.
  void begin() const;
  /// For the shading pass: binds the targets to units first_unit.. and sets the samplers of
  /// `program`, in use.
  void bind(const gl::Program& program, int first_unit) const;

  /// What such targets take, without the depth texture.
  static std::size_t bytes(FeatureStorage storage, glm::ivec2 size);

  /// With (slot, barycentrics) as RG32UI, or 0 where features are stored.
  GLuint visibility_framebuffer() const;

 private:
  FeatureStorage storage_ = FeatureStorage::visibility;
  std::array<gl::Texture, 2> targets_;  // the second only where features are stored
  gl::Framebuffer framebuffer_;
};

}  // namespace tureen
