#include "jobs/baseline/splat_baseline_pass.hpp"

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "jobs/baseline/baseline_passes.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"
#include "runtime/splats/device_splats.hpp"

namespace tureen {

namespace {

gl::Program program_of(const SplatPlan& plan, const TexelLayout& layout, gl::Api api) {
  const bool windows = splatting::facts_of(plan.kind).shaders == "windows";
  const bool keeps = plan.profile.low_pass == SplatProfile::LowPass::mip;
  return gl::Program(
      assemble({.file = windows ? "baseline_windows.vert" : "baseline_gaussians.vert",
                .constants = {{"TEXEL_ROW_BITS", std::to_string(layout.row_bits)},
                              {"TEXEL_LAYER_BITS", std::to_string(layout.layer_bits)},
                              {"HARMONICS_DEGREE", std::to_string(plan.harmonics_degree)},
                              {"KEEP_INTEGRAL", keeps ? "1" : "0"}}},
               api),
      assemble({.file = windows ? "baseline_windows.frag" : "baseline_gaussians.frag"}, api));
}

/// The source with the texels of Gaussians replaced by centre, covariance and opacity.
SplatSource with_covariances(SplatSource source, const Gaussians& gaussians) {
  std::vector<glm::vec4> texels;
  texels.reserve(3 * gaussians.centers.size());
  for (std::size_t i = 0; i < gaussians.centers.size(); ++i) {
    glm::dvec3 scales(gaussians.scales[i]);
    if (gaussians.flat) scales.z = 0;
    glm::dmat3 axes = glm::mat3_cast(glm::dquat(gaussians.rotations[i]));
    for (int axis = 0; axis < 3; ++axis) axes[axis] *= scales[axis];
    const glm::mat3 c(axes * glm::transpose(axes));
    texels.emplace_back(gaussians.centers[i], c[0][0]);
    texels.emplace_back(c[0][1], c[0][2], c[1][1], c[1][2]);
    texels.emplace_back(c[2][2], gaussians.opacity[i], 0.0f, 0.0f);
  }
  source.kernel = TexelSource::of(texel_formats::rgba32f, std::move(texels), "splats");
  return source;
}

}  // namespace

SplatBaselinePass::SplatBaselinePass(const gl::Capabilities& device, const SplatSource& source,
                                     const SplatPlan& plan)
    : device_(device),
      profile_(plan.profile),
      centers_(source.centers),
      kernel_(source.layout, source.kernel),
      coefficients_(source.layout, source.coefficients),
      program_(program_of(plan, source.layout, device.api)),
      splats_(gl::Buffer::create()) {
  gl::check("SplatBaselinePass");
}

void SplatBaselinePass::resize(const FrameTarget& target) {
  size_ = target.size();
  transparent_.reset();
}

void SplatBaselinePass::draw(const Frame& frame, FrameTarget& target) {
  const FrameCamera& camera = frame.layers.front();
  const glm::vec4& background = frame.background;
  const bool opaque = background.a == 1.0f;
  if (!opaque && !transparent_) {
    transparent_.emplace(device_.api, BlendFormat{target_formats::rgba8});
    transparent_->resize(size_);
    transparent_framebuffer_ = make_framebuffer({transparent_->texture()});
  }
  target.overwrite_color();
  if (!opaque) glBindFramebuffer(GL_FRAMEBUFFER, transparent_framebuffer_.id());
  const glm::vec4 behind = opaque ? background : glm::vec4(0.0f);
  glClearBufferfv(GL_COLOR, 0, &behind[0]);
  if (camera.visible && !centers_.empty()) {
    program_.use();
    set_view(frame);
    order_splats(camera);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(centers_.size()));
    glDisable(GL_BLEND);
  }
  if (opaque) return;
  target.overwrite_color();
  glClearBufferfv(GL_COLOR, 0, &background[0]);
  transparent_->composite_over(target);
}

void SplatBaselinePass::order_splats(const FrameCamera& camera) {
  const std::span<const std::uint32_t> order = order_.sort(centers_, camera);
  const bool is_new = vertex_array_.bind();
  glBindBuffer(GL_ARRAY_BUFFER, splats_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(order.size_bytes()), order.data(),
               GL_STREAM_DRAW);
  if (!is_new) return;
  glEnableVertexAttribArray(0);
  glVertexAttribIPointer(0, 1, GL_UNSIGNED_INT, 0, nullptr);
  glVertexAttribDivisor(0, 1);
}

void SplatBaselinePass::set_view(const Frame& frame) {
  const FrameCamera& in_layer = frame.layers.front();
  const Camera& camera = in_layer.camera;
  program_.set_texture("kernel", 0, kernel_.texture(), GL_TEXTURE_2D_ARRAY);
  program_.set_texture("coefficients", 1, coefficients_.texture(), GL_TEXTURE_2D_ARRAY);
  set_eye(program_, in_layer.eye);
  program_.set("view_from_layer", glm::mat3(glm::dmat3(camera.view_from_world)));
  program_.set("focal", glm::vec2(camera.fx, camera.fy));
  program_.set("principal_point", glm::vec2(camera.cx, camera.height - camera.cy));
  program_.set("half_size", 0.5f * glm::vec2(camera.width, camera.height));
  program_.set("near", static_cast<float>(in_layer.range.near));
  program_.set("min_center_depth", profile_.min_center_depth);
  program_.set("slope_range", ewa_slope_range(frame.input.whole.value_or(camera)));
  const bool dilates = profile_.low_pass == SplatProfile::LowPass::dilation ||
                       profile_.low_pass == SplatProfile::LowPass::mip;
  const double pixel_area = frame.samples_per_pixel * frame.samples_per_pixel;
  program_.set("dilation", dilates ? static_cast<float>(dilation_variance * pixel_area) : 0.0f);
}

std::size_t SplatBaselinePass::device_bytes() const {
  return kernel_.device_bytes() + coefficients_.device_bytes() +
         centers_.size() * sizeof(std::uint32_t);
}

void SplatBaselinePass::leave_context() {
  vertex_array_.forget();
  transparent_.reset();
  transparent_framebuffer_ = {};
}

MakePasses baseline_passes(const Splats& splats, const SplatPlan& plan,
                           const DeviceLimits& limits) {
  SplatSource source = prepare_splats(splats, plan, TexelLayout::of(limits));
  if (const auto* gaussians = std::get_if<Gaussians>(&splats.kernel))
    source = with_covariances(std::move(source), *gaussians);
  return [source = std::move(source)](const gl::Capabilities& device, const RenderPlan& of_scene) {
    Passes passes;
    passes.push_back(std::make_unique<SplatBaselinePass>(device, source, of_scene.splats(0)));
    return passes;
  };
}

}  // namespace tureen
