// A likeness of the published DiffSoup viewer (arXiv 2603.27151), kept as the baseline: two
// RGBA8 feature targets, all channels of every fragment sampled before the alpha test, faces in
// file order, then the network on every pixel of the window with its weights in mat4 uniforms. It
// has the viewer's shortcomings too: features quantised twice, one lattice level, lookup textures
// that must fit the device's largest 2D texture.
#include <algorithm>
#include <cstring>
#include <glm/matrix.hpp>

#include "base/error.hpp"
#include "jobs/baseline/baseline.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/pipeline.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"
#include "runtime/plan/color_mlp_source.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int lut_width = 4096;

class BaselinePipeline final : public Pipeline {
 public:
  BaselinePipeline(const gl::Capabilities& capabilities, const DeviceLimits& limits,
                   const TriangleSoup& soup, const RenderPlan& plan)
      : face_count_(plan.faces.size()), geometry_(prepare_geometry(soup, plan.faces)) {
    const auto& texture = std::get<LatticeTexture>(soup.appearance);
    upload_lookup_textures(texture, plan, limits);
    network_ = color_mlp_source(*texture.mlp, MlpWeights::uniforms);
    const std::string level = std::to_string(plan.lattice.uniform_level);
    geometry_program_ =
        gl::Program(assemble({.file = "geometry.vert"}, capabilities.api),
                    assemble({.file = "baseline_geometry.frag",
                              .constants = {{"LATTICE_LEVEL", level}, {"ALPHA_THRESHOLD", "0.5"}},
                              .generated = {}},
                             capabilities.api));
    ShaderSource shading{.file = "baseline_shading_with_network",
                         .constants = {{"HARMONICS_DEGREE", "2"}},
                         .generated = {{"baseline_shading_with_network",
                                        "#include \"baseline_shading.frag\"\n" + network_.text}}};
    shading_program_ = gl::Program(assemble({.file = "full_screen.vert"}, capabilities.api),
                                   assemble(shading, capabilities.api));
    gl::check("BaselinePipeline");
  }

  void resize(int width, int height) override {
    width_ = width;
    height_ = height;
    depth_ = make_target(target_formats::depth24, width, height);
    target0_ = make_target(target_formats::rgba8, width, height);
    target1_ = make_target(target_formats::rgba8, width, height);
    color_ = make_target(target_formats::rgba8, width, height);
    feature_framebuffer_ = make_framebuffer({target0_.id(), target1_.id()}, depth_.id());
    color_framebuffer_ = make_framebuffer({color_.id()}, 0);
  }

  void draw(const FrameCamera& frame, const glm::vec4& background) override {
    gl::use_plain_rasterisation(width_, height_);
    glDepthFunc(GL_LESS);
    const glm::dmat4 projection = clip_from_view(frame.camera, frame.range.near, frame.range.far);
    draw_features(frame, projection, background);
    draw_shading(frame, projection, background);
    gl::check("baseline draw");
  }

  GLuint color_framebuffer() const override { return color_framebuffer_.id(); }
  GLuint color_texture() const override { return color_.id(); }
  glm::ivec2 sample_size() const override { return {width_, height_}; }
  void leave_context() override {
    geometry_.leave_context();
    nothing_.forget();
    feature_framebuffer_ = {};
    color_framebuffer_ = {};
  }
  std::size_t device_bytes() const override { return geometry_.device_bytes() + lut_bytes_; }
  std::size_t target_bytes() const override {
    const glm::ivec2 size = sample_size();
    return bytes_of(target_formats::depth24, size) + 3 * bytes_of(target_formats::rgba8, size);
  }

 private:
  void draw_features(const FrameCamera& frame, const glm::dmat4& projection,
                     const glm::vec4& background) {
    const gl::TimedPass pass(timer_, "features");
    glBindFramebuffer(GL_FRAMEBUFFER, feature_framebuffer_.id());
    const float clear0[4] = {background.r, background.g, background.b, 0};
    const float clear1[4] = {0, 0, 0, 0};
    const float far = 1.0f;
    glClearBufferfv(GL_COLOR, 0, clear0);
    glClearBufferfv(GL_COLOR, 1, clear1);
    glClearBufferfv(GL_DEPTH, 0, &far);
    geometry_program_.use();
    Geometry::set_camera(geometry_program_, frame, projection);
    bind_texture(0, lut0_.id());
    bind_texture(1, lut1_.id());
    geometry_program_.set("lut0", 0);
    geometry_program_.set("lut1", 1);
    geometry_program_.set("lut_width", lut_width);
    geometry_.bind();
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * face_count_));
  }

  void draw_shading(const FrameCamera& frame, const glm::dmat4& projection,
                    const glm::vec4& background) {
    const gl::TimedPass pass(timer_, "shading");
    glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer_.id());
    glDisable(GL_DEPTH_TEST);
    shading_program_.use();
    bind_texture(0, target0_.id());
    bind_texture(1, target1_.id());
    shading_program_.set("target0", 0);
    shading_program_.set("target1", 1);
    glm::dmat4 view = frame.camera.view_from_world;
    view[3] = glm::dvec4(glm::dmat3(view) * -frame.eye, 1.0);
    shading_program_.set("world_from_clip", glm::mat4(glm::inverse(projection * view)));
    shading_program_.set("window_size", glm::vec2(width_, height_));
    shading_program_.set("background", background);
    shading_program_.set("background_depth", 0.0f);
    shading_program_.set("mlp_weights", std::span<const glm::mat4>(network_.weights));
    shading_program_.set("mlp_biases", std::span<const glm::vec4>(network_.biases));
    nothing_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
  }

  static void bind_texture(int unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
    gl::use_texture_sampling(static_cast<unsigned>(unit));
  }

  void upload_lookup_textures(const LatticeTexture& texture, const RenderPlan& plan,
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
    std::vector<std::uint8_t> lut[2];
    for (int half = 0; half < 2; ++half) {
      lut[half].resize(rows * lut_width * 4);
      for (std::size_t slot = 0; slot < plan.faces.size(); ++slot)
        for (std::uint32_t k = 0; k < per_face; ++k)
          for (int c = 0; c < 4; ++c)
            lut[half][(slot * per_face + k) * 4 + std::size_t(c)] =
                stored(texture, texture.patches[plan.faces[slot]].first_texel + std::size_t(k),
                       4 * half + c);
    }
    lut0_ = lookup_texture(lut[0], rows);
    lut1_ = lookup_texture(lut[1], rows);
    lut_bytes_ = lut[0].size() + lut[1].size();
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
  gl::LocalVertexArray nothing_;
  ColorMlpSource network_;
  gl::Program geometry_program_, shading_program_;
  gl::Texture lut0_, lut1_;
  std::size_t lut_bytes_ = 0;
  int width_ = 0, height_ = 0;
  gl::Texture depth_, target0_, target1_, color_;
  gl::Framebuffer feature_framebuffer_, color_framebuffer_;
};

}  // namespace

Renderer make_baseline_renderer(const gl::Context& context, const TriangleSoup& soup,
                                glm::dvec3 origin, RenderPlan plan, const RenderOptions& options) {
  const gl::Capabilities& capabilities = context.capabilities();
  const DeviceLimits limits = options.limits.value_or(device_limits(capabilities));
  gl::use_plain_pixel_transfer();
  auto pipeline = std::make_unique<BaselinePipeline>(capabilities, limits, soup, plan);
  return Renderer(context, std::move(pipeline), std::move(plan), bounds(soup), origin, options);
}

Renderer make_renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                       PipelineKind kind, const RenderOptions& options) {
  if (kind == PipelineKind::tureen) return Renderer(context, soup, origin, options);
  return make_baseline_renderer(context, soup, origin, make_baseline_plan(soup, options.plan),
                                options);
}

}  // namespace tureen
