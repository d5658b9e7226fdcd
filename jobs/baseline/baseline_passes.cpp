// The baseline's two passes. They are a likeness of the published DiffSoup viewer (arXiv
// 2603.27151): two RGBA8 feature targets, all channels of every fragment sampled before the alpha
// test, faces in file order, then the network on every pixel of the window with its weights in mat4
// uniforms. It has the viewer's shortcomings too: features quantised twice, one lattice level,
// lookup textures that must fit the device's largest 2D texture.
#include "jobs/baseline/baseline_passes.hpp"

#include <algorithm>
#include <glm/matrix.hpp>

#include "base/error.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"
#include "runtime/plan/color_mlp_source.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int lut_width = 4096;

/// Draws the eight interpolated features of the visible faces into two targets.
class FeaturesPass final : public Pass {
 public:
  FeaturesPass(const gl::Capabilities& device, const DeviceLimits& limits, const TriangleSoup& soup,
               const SoupPlan& plan)
      : face_count_(plan.faces.size()), geometry_(prepare_geometry(soup, plan.faces)) {
    upload_lookup_textures(std::get<LatticeTexture>(soup.appearance), plan, limits);
    const std::string level = std::to_string(plan.lattice.uniform_level);
    program_ =
        gl::Program(assemble({.file = "geometry.vert"}, device.api),
                    assemble({.file = "baseline_geometry.frag",
                              .constants = {{"LATTICE_LEVEL", level}, {"ALPHA_THRESHOLD", "0.5"}},
                              .generated = {}},
                             device.api));
    gl::check("FeaturesPass");
  }

  const char* name() const override { return "features"; }

  void resize(const FrameTarget& target) override {
    size_ = target.size();
    for (gl::Texture& texture : features_)
      texture = make_target(target_formats::rgba8, size_.x, size_.y);
    framebuffer_ =
        make_framebuffer({features_[0].id(), features_[1].id()}, target.depth_attachment());
  }

  void draw(const Frame& frame, FrameTarget& target) override {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    const glm::vec4& background = frame.background;
    const float clear0[4] = {background.r, background.g, background.b, 0};
    const float clear1[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, clear0);
    glClearBufferfv(GL_COLOR, 1, clear1);
    target.use_depth();
    program_.use();
    const FrameCamera& view = frame.layers.front();
    Geometry::set_camera(program_, view, target.clip_from_view(view.camera, view.range));
    program_.set_texture("lut0", 0, lookup_[0].id());
    program_.set_texture("lut1", 1, lookup_[1].id());
    program_.set("lut_width", lut_width);
    geometry_.bind();
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * face_count_));
  }

  std::size_t device_bytes() const override { return geometry_.device_bytes() + lookup_bytes_; }
  std::size_t target_bytes() const override { return 2 * bytes_of(target_formats::rgba8, size_); }
  void leave_context() override {
    geometry_.leave_context();
    framebuffer_ = {};
  }

  /// One of the two targets.
  GLuint features(std::size_t half) const { return features_[half].id(); }

 private:
  void upload_lookup_textures(const LatticeTexture& texture, const SoupPlan& plan,
                              const DeviceLimits& limits) {
    const std::uint32_t per_face = lattice::texel_count(plan.lattice.uniform_level);
    const std::size_t texels = plan.faces.size() * per_face;
    if (lut_width > limits.max_texture_size)
      throw DeviceLimitError("the baseline needs lookup textures " + std::to_string(lut_width) +
                             " texels wide; the limit of this device is " +
                             std::to_string(limits.max_texture_size));
    const std::size_t rows = std::max<std::size_t>((texels + lut_width - 1) / lut_width, 1);
    if (rows > std::size_t(limits.max_texture_size))
      throw DeviceLimitError(
          "the baseline needs a lookup texture of " + std::to_string(rows) +
          " rows; the limit of this device is " + std::to_string(limits.max_texture_size) +
          ", enough for " +
          std::to_string(std::size_t(limits.max_texture_size) * lut_width / per_face) +
          " triangles at this level");
    for (int half = 0; half < 2; ++half) {
      std::vector<std::uint8_t> lut(rows * lut_width * 4);
      for (std::size_t slot = 0; slot < plan.faces.size(); ++slot)
        for (std::uint32_t k = 0; k < per_face; ++k)
          for (int c = 0; c < 4; ++c)
            lut[(slot * per_face + k) * 4 + std::size_t(c)] =
                stored(texture, texture.patches[plan.faces[slot]].first_texel + std::size_t(k),
                       4 * half + c);
      lookup_[half] = lookup_texture(lut, rows);
      lookup_bytes_ += lut.size();
    }
  }

  /// Float texels are truncated to bytes as the published exporter does.
  static std::uint8_t stored(const LatticeTexture& texture, std::size_t texel, int channel) {
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&texture.texels))
      return (*bytes)[texel * LatticeTexture::channels + std::size_t(channel)];
    return static_cast<std::uint8_t>(std::clamp(texture.value(texel, channel), 0.0f, 1.0f) *
                                     255.0f);
  }

  static gl::Texture lookup_texture(const std::vector<std::uint8_t>& bytes, std::size_t rows) {
    gl::Texture texture = make_target(target_formats::rgba8, lut_width, static_cast<int>(rows));
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, lut_width, static_cast<GLsizei>(rows), GL_RGBA,
                    GL_UNSIGNED_BYTE, bytes.data());
    return texture;
  }

  std::size_t face_count_;
  Geometry geometry_;
  gl::Program program_;
  gl::Texture lookup_[2];
  std::size_t lookup_bytes_ = 0;
  glm::ivec2 size_{0};
  gl::Texture features_[2];
  gl::Framebuffer framebuffer_;
};

/// Evaluates the network on every pixel.
class NetworkPass final : public Pass {
 public:
  /// `features` must outlive this object.
  NetworkPass(const gl::Capabilities& device, const ColorMlp& mlp, const FeaturesPass& features)
      : features_(features), network_(color_mlp_source(mlp, MlpWeights::uniforms)) {
    ShaderSource shading{.file = "baseline_shading_with_network",
                         .constants = {{"HARMONICS_DEGREE", "2"}},
                         .generated = {{"baseline_shading_with_network",
                                        "#include \"baseline_shading.frag\"\n" + network_.text}}};
    program_ = full_screen_program(shading, device.api);
    gl::check("NetworkPass");
  }

  const char* name() const override { return "shading"; }

  void draw(const Frame& frame, FrameTarget& target) override {
    target.overwrite_color();
    const FrameCamera& view = frame.layers.front();
    program_.use();
    program_.set_texture("target0", 0, features_.features(0));
    program_.set_texture("target1", 1, features_.features(1));
    glm::dmat4 view_from_layer = view.camera.view_from_world;
    view_from_layer[3] = glm::dvec4(glm::dmat3(view_from_layer) * -view.eye, 1.0);
    const glm::dmat4 projection = target.clip_from_view(view.camera, view.range);
    program_.set("world_from_clip", glm::mat4(glm::inverse(projection * view_from_layer)));
    program_.set("window_size", glm::vec2(target.size()));
    program_.set("background", frame.background);
    program_.set("mlp_weights", std::span<const glm::mat4>(network_.weights));
    program_.set("mlp_biases", std::span<const glm::vec4>(network_.biases));
    full_screen_.draw(program_);
  }

  void leave_context() override { full_screen_.leave_context(); }

 private:
  const FeaturesPass& features_;
  ColorMlpSource network_;
  gl::Program program_;
  FullScreen full_screen_;
};

}  // namespace

MakePasses baseline_passes(const TriangleSoup& soup, const DeviceLimits& limits) {
  return [&soup, limits](const gl::Capabilities& device, const RenderPlan& plan) {
    auto features = std::make_unique<FeaturesPass>(device, limits, soup, plan.soup(0));
    const ColorMlp& mlp = *std::get<LatticeTexture>(soup.appearance).mlp;
    auto network = std::make_unique<NetworkPass>(device, mlp, *features);
    Passes passes;
    passes.push_back(std::move(features));
    passes.push_back(std::move(network));
    return passes;
  };
}

}  // namespace tureen
