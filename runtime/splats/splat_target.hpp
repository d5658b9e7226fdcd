// The texture with a frame's blended splats, which is composited over the frame's colours.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/frame_target.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/passes/targets.hpp"
#include "runtime/plan/splat_plan.hpp"

namespace tureen {

/// How colours are stored while they are blended.
struct BlendFormat {
  TargetFormat texture;  // RGBA
  /// The stored value of colour 1. Less than 1 if the format stores only values up to 1.
  float color_unit = 1;
};

/// The format for splats whose alpha is at least `min_alpha` where they are blended, and whose
/// colours are at most `largest_color`. A format that the device or the colours do not allow is
/// replaced by the next better one, or by rgba16f.
BlendFormat blend_format(SplatFormat requested, const gl::Capabilities& device, float min_alpha,
                         float largest_color);

class SplatTarget {
 public:
  SplatTarget(gl::Api api, const BlendFormat& format);

  /// Creates the textures; their contents are undefined. Throws DeviceLimitError.
  void resize(glm::ivec2 size);
  glm::ivec2 size() const { return size_; }
  /// Premultiplied colours in the format's unit, and alpha, row 0 at the bottom.
  GLuint texture() const { return blended_.id(); }

  /// Composites the texture over the colours of the frame, or over its background.
  void composite_over(FrameTarget& target);

  /// The colours of `framebuffer`, whose first target is the texture: premultiplied RGBA, row 0 on
  /// top. Waits for the device.
  std::vector<glm::vec4> read(const gl::Framebuffer& framebuffer) const;

  /// Bytes of the textures, by their formats.
  std::size_t bytes() const;
  /// See Renderer::leave_context(). resize() must follow.
  void leave_context();

 private:
  gl::Api api_;
  BlendFormat format_;
  std::optional<gl::Program> over_colors_, over_background_;  // made for the first such frame
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  gl::Texture blended_, behind_;
  gl::Framebuffer behind_framebuffer_;
};

/// A pass that blends the splats of all layers, in a SplatTarget.
class SplatBlendingPass : public Pass {
 public:
  const char* name() const override { return "splats"; }
  /// The blended splats of the last frame, premultiplied RGBA, row 0 on top; colours may exceed 1.
  /// Waits for the device.
  virtual std::vector<glm::vec4> read_blended() = 0;
};

}  // namespace tureen
