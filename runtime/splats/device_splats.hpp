// One layer of splats on the device.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/frame_target.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/plan/splat_plan.hpp"
#include "runtime/splats/hidden_tiles.hpp"
#include "runtime/splats/splat_source.hpp"

namespace tureen {

/// Bytes per splat of the textures that hold what all pixels of a splat share.
std::size_t projected_bytes(const SplatPlan& plan);

/// The values that the fragments of a splat write (shaders/splats/splat_blended.glsl).
enum class SplatOutput {
  color,        // premultiplied, and alpha
  sums,         // two targets: alpha times normal and 1; alpha times depth, opacity, sigma and 1
  prefixes,     // alpha of those splats that belong to each of four prefixes of the order
  depth_found,  // the depth of the splat that a search has found; other fragments are discarded
  sample,       // colour and 1 with the probability of alpha, at the depth of the splat's centre
  counts,       // 1; 1 in front of the splat that a search has found; 0; the place in the order
};
inline constexpr std::size_t splat_outputs = 6;

struct SplatDrawing {
  SplatOutput output = SplatOutput::color;
  GLuint bounds = 0;                    // texture of a search (splat_measures.hpp)
  const HiddenTiles* hidden = nullptr;  // where splats are skipped; only with SplatOutput::color
};

class DeviceSplats {
 public:
  /// Columns of the texture with the order of the splats: ORDER_COLUMNS.
  static constexpr int order_columns = 2048;

  /// Uploads; of the plan, only `kind`, `profile`, `as_published`, `harmonics_degree`,
  /// `colors_per_splat`, `largest_color`, `applied`, `chunks` and the number of drawn splats are
  /// used. The source's texels are not needed afterwards. Throws DeviceLimitError.
  DeviceSplats(const gl::Capabilities& device, SplatSource source, const SplatPlan& plan);

  /// The layer's index in Frame::layers.
  void set_layer(std::size_t layer) { layer_ = layer; }
  std::size_t layer() const { return layer_; }

  const gl::Capabilities& device() const { return device_; }
  const SplatProfile& profile() const { return profile_; }
  float largest_color() const { return largest_color_; }  // SplatPlan::largest_color
  /// Specialisation::hidden_splats
  bool may_skip_hidden() const { return may_skip_hidden_; }

  /// Centres of the drawn splats, in layer coordinates.
  std::span<const glm::vec3> centers() const { return centers_; }
  /// SplatPlan::chunks.
  std::span<const Bounds> chunks() const { return chunks_; }

  /// Computes colours, with this value for colour 1, and for Gaussians their places in the image,
  /// for later draw_run() of this frame. Changes the framebuffer and the viewport.
  void project(const Frame& frame, float color_unit = 1);
  /// Prepares draw_run(): program, textures and uniforms. `order` is a texture with the indices of
  /// splats, row by row. The first drawing with an output compiles its program.
  void begin_runs(const Frame& frame, const FrameTarget& target, GLuint order,
                  const SplatDrawing& drawing);
  /// Draws `count` splats of the order from `first` on, as three vertices each.
  void draw_run(std::uint32_t first, std::uint32_t count);

  /// Whether the fragment shader tests depth, because it differs from pixel to pixel. The caller
  /// then binds a framebuffer without the depth texture.
  bool tests_depth() const;

  std::size_t device_bytes() const;
  /// See Renderer::leave_context().
  void leave_context();

 private:
  using Constants = std::map<std::string, std::string>;

  bool has_published_culls() const;
  Constants constants() const;
  gl::Program make_program(SplatOutput output) const;
  void set_view(const gl::Program& program, const Frame& frame) const;
  /// Texels that projection_ computes, one a colour, and their rows.
  std::size_t projected_texels() const { return centers_.size() * std::size_t(colors_per_splat_); }
  std::size_t projected_rows() const;

  splatting::LayerKind kind_;
  SplatProfile profile_;
  bool as_published_;
  int harmonics_degree_, colors_per_splat_;
  float largest_color_;
  bool may_skip_hidden_;
  std::size_t layer_ = 0;
  std::vector<glm::vec3> centers_;
  std::vector<Bounds> chunks_;
  TexelLayout layout_;
  TexelStore kernel_, coefficients_;
  gl::Capabilities device_;
  gl::Program projection_;
  std::array<std::optional<gl::Program>, splat_outputs> drawings_;  // by SplatOutput
  std::vector<gl::Texture> projected_;  // colours and, for some kernels, more
  gl::Framebuffer projected_framebuffer_;
  FullScreen full_screen_;
  gl::LocalVertexArray nothing_;
};

/// The range of x/depth and y/depth, in the camera's view space with y upwards, to which EWA
/// splatting clamps the centre in its Jacobian: the smallest x and y, then the largest.
glm::vec4 ewa_slope_range(const Camera& camera);

}  // namespace tureen
