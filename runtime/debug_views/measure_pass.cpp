#include "runtime/debug_views/measure_pass.hpp"

#include <cmath>

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

SplatMeasure measure_of(DebugView what) {
  switch (what) {
    case DebugView::median_depth:
      return SplatMeasure::median_depth;
    case DebugView::overdraw:
    case DebugView::contributions:
    case DebugView::order:
      return SplatMeasure::counts;
    default:
      return SplatMeasure::sums;
  }
}

}  // namespace

MeasurePass::MeasurePass(const Inputs& inputs)
    : subjects_(inputs.subjects), shown_(inputs.shown), counts_(inputs.counts) {
  if (!inputs.splats.empty())
    measures_.emplace(inputs.device, inputs.splats, measure_of(shown_.what));
  if (inputs.make_surfaces) surfaces_ = inputs.make_surfaces(surface_framebuffer_);
  auto constants = debug_view_constants(shown_.what);
  constants["HAS_SPLATS"] = measures_ ? "1" : "0";
  constants["HAS_SOUPS"] = surfaces_.empty() ? "0" : "1";
  constants["VALUES"] = shown_.as_values ? "1" : "0";
  program_ =
      full_screen_program({.file = "measured.frag", .constants = constants}, inputs.device.api);
}

void MeasurePass::resize(const FrameTarget& target) {
  size_ = target.size();
  if (measures_) measures_->resize(target);
  if (!surfaces_.empty()) {
    surface_ = make_target(target_formats::rgba32f, size_.x, size_.y);
    surface_framebuffer_ = make_framebuffer({surface_.id()}, target.depth_attachment());
  }
  if (shown_.as_values) {
    values_ = make_target(target_formats::rgba32f, size_.x, size_.y);
    values_framebuffer_ = make_framebuffer({values_.id()});
  }
}

void MeasurePass::draw(const Frame& frame, FrameTarget& target) {
  if (!surfaces_.empty()) draw_surfaces(frame, target);
  if (measures_) measures_->draw(frame, target);
  show(frame, target);
}

void MeasurePass::draw_surfaces(const Frame& frame, FrameTarget& target) {
  constexpr GLfloat nothing[4] = {0, 0, 0, 0};
  glBindFramebuffer(GL_FRAMEBUFFER, surface_framebuffer_.id());
  glClearBufferfv(GL_COLOR, 0, nothing);
  for (const std::unique_ptr<Pass>& pass : surfaces_) {
    gl::use_plain_rasterisation(size_.x, size_.y);
    pass->draw(frame, target);
  }
}

void MeasurePass::show(const Frame& frame, FrameTarget& target) {
  const DepthScale scale = shown_.scale = depth_scale_of(frame, subjects_);
  gl::use_plain_rasterisation(size_.x, size_.y);
  if (shown_.what == DebugView::alpha) {
    target.draw_color();  // clears the colours if no pass has drawn any
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
  target.overwrite_color();
  if (shown_.as_values) {
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_FRAMEBUFFER, values_framebuffer_.id());
  }
  program_.use();
  if (measures_) {
    program_.set_texture("first", 0, measures_->texture(0));
    program_.set_texture("second", 1, measures_->texture(1));
    program_.set("splat_count", static_cast<float>(measures_->splat_count()));
  }
  if (!surfaces_.empty()) program_.set_texture("surface", 2, surface_.id());
  if (counts_) program_.set_texture("counts", 3, counts_->texture());
  program_.set("background", frame.background);
  program_.set("depth_scale",
               glm::vec2(std::log(scale.near), 1.0 / std::log(scale.far / scale.near)));
  full_screen_.draw(program_);
  glDisable(GL_BLEND);
}

std::vector<glm::vec4> MeasurePass::read_values() const {
  if (!shown_.as_values) return {};
  return read_float_pixels(values_framebuffer_.id(), size_);
}

std::size_t MeasurePass::device_bytes() const { return measures_ ? measures_->device_bytes() : 0; }

std::size_t MeasurePass::target_bytes() const {
  const std::size_t own = (surface_ ? 1u : 0u) + (values_ ? 1u : 0u);
  return own * bytes_of(target_formats::rgba32f, size_) +
         (measures_ ? measures_->target_bytes() : 0);
}

void MeasurePass::leave_context() {
  full_screen_.leave_context();
  if (measures_) measures_->leave_context();
  for (const std::unique_ptr<Pass>& pass : surfaces_) pass->leave_context();
  surface_framebuffer_ = {};
  values_framebuffer_ = {};
}

}  // namespace tureen
