// The textures that the passes of a frame draw into: for each sample the visible fragment, depth
// and colour. The first use of a texture in a frame clears it, except in overwrite_color(). No pass
// therefore relies on an earlier pass to clear a texture.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "runtime/gl/objects.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/targets.hpp"
#include "scene/camera.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

/// The textures that the passes of a plan need.
struct FrameFormat {
  bool visibility = false;      // a pass stores visible fragments
  bool reversed_depth = false;  // depth is a float, 1 near and 0 far; otherwise 24 bits, 0 near
  bool image_store = false;     // compute shaders write the colours
  bool layered = false;         // several layers: the stencil stores the layer of each sample
  bool operator==(const FrameFormat&) const = default;
};

class FrameTarget {
 public:
  explicit FrameTarget(const FrameFormat& format) : format_(format) {}

  /// Takes effect at the next resize().
  void set_format(const FrameFormat& format) { format_ = format; }
  const FrameFormat& format() const { return format_; }

  /// Creates the textures for this number of samples; their contents are undefined. Throws
  /// DeviceLimitError.
  void resize(glm::ivec2 size);
  glm::ivec2 size() const { return size_; }
  /// Bytes of the textures, by their formats; a driver may use more.
  std::size_t bytes() const;

  /// Starts a frame. Cleared colours get the value `background`.
  void begin(const glm::vec4& background);
  /// Binds the visible fragments and depth as targets: (slot, barycentrics) as RG32UI, see
  /// shaders/visibility.frag. Nearer fragments win; the samples that they cover become those of
  /// this layer. Requires FrameFormat::visibility.
  void draw_visibility(std::size_t layer);
  /// Binds colour and depth as targets. Nearer fragments win.
  void draw_color();
  /// Binds colour, so that a triangle over the whole target at far_depth() writes only the samples
  /// of this layer. Depth is not written.
  void draw_samples_of(std::size_t layer);
  /// Ends a frame: clears the colour if no pass has drawn any.
  void end();
  /// Binds colour for a pass that writes every sample: nothing is cleared, and depth is neither
  /// tested nor written.
  void overwrite_color();
  /// Prepares depth for a pass that has bound its own framebuffer with the depth texture. Clears
  /// depth at the first use of depth in the frame. Nearer fragments win.
  void use_depth();

  /// Binds the visible fragments to a texture unit, and sets the sampler `visible` of `program`,
  /// which is in use.
  void bind_visibility(const gl::Program& program, int unit) const;

  /// The matrix from view coordinates to clip coordinates. FrameFormat::reversed_depth selects
  /// its depth range.
  glm::dmat4 clip_from_view(const Camera& camera, const ClipRange& range) const;

  /// The colour of samples that no pass has drawn.
  const glm::vec4& background() const { return background_; }
  /// Whether a pass has drawn colours in this frame.
  bool has_color() const { return color_drawn_; }
  /// Whether the last frame stored visible fragments, or depth.
  bool has_visibility() const { return visibility_drawn_; }
  bool has_depth() const { return depth_drawn_; }
  bool reversed_depth() const { return format_.reversed_depth; }
  bool layered() const { return format_.layered; }
  /// The depth of samples that no pass has drawn.
  float far_depth() const { return format_.reversed_depth ? 0.0f : 1.0f; }
  /// Depth functions: the first accepts only nearer fragments, the second also equal depth.
  GLenum nearer() const { return format_.reversed_depth ? GL_GREATER : GL_LESS; }
  GLenum nearer_or_equal() const { return format_.reversed_depth ? GL_GEQUAL : GL_LEQUAL; }

  GLuint visibility_framebuffer() const { return visibility_framebuffer_.id(); }
  GLuint color_framebuffer() const { return color_framebuffer_.id(); }
  /// GL_TEXTURE_2D, nearest sampling; row 0 at the bottom.
  GLuint color_texture() const { return color_.id(); }
  GLuint depth_texture() const { return depth_.id(); }
  /// The depth texture as an attachment for a pass's own framebuffer.
  DepthAttachment depth_attachment() const { return {depth_.id(), format_.layered}; }

  /// See Renderer::leave_context(). resize() must follow.
  void leave_context();

 private:
  const TargetFormat& depth_format() const;

  FrameFormat format_;
  glm::ivec2 size_{0};
  gl::Texture visible_, depth_, color_;
  gl::Framebuffer visibility_framebuffer_, color_framebuffer_;
  glm::vec4 background_{0.0f};
  bool visibility_drawn_ = false, depth_drawn_ = false, color_drawn_ = false;  // in this frame
};

}  // namespace tureen
