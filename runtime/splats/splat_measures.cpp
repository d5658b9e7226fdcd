#include "runtime/splats/splat_measures.hpp"

#include <utility>

#include "runtime/gl/state.hpp"

namespace tureen {

namespace {

/// A step of the search leaves this part of a range of prefixes (splat_prefixes.glsl).
constexpr std::uint32_t parts = 5;

}  // namespace

SplatMeasures::SplatMeasures(const gl::Capabilities& device, std::span<DeviceSplats* const> layers,
                             SplatMeasure what)
    : what_(what),
      blended_format_(device.float_blending ? target_formats::rgba32f : target_formats::rgba16f),
      splats_(layers) {
  if (what_ != SplatMeasure::sums)
    narrow_ = full_screen_program({.file = "splat_search.frag"}, device.api);
}

void SplatMeasures::resize(const FrameTarget& target) {
  size_ = target.size();
  results_.clear();
  if (what_ == SplatMeasure::sums) {
    for (int i = 0; i < 2; ++i) results_.push_back(make_target(blended_format_, size_.x, size_.y));
    result_framebuffers_ = make_splat_framebuffers({results_[0].id(), results_[1].id()}, target);
    return;
  }
  // Depths are not blended.
  results_.push_back(
      make_target(what_ == SplatMeasure::median_depth ? target_formats::rgba32f : blended_format_,
                  size_.x, size_.y));
  result_framebuffers_ = make_splat_framebuffers({results_[0].id()}, target);
  for (int i = 0; i < 2; ++i) {
    bounds_[i] = make_target(target_formats::rg32ui, size_.x, size_.y);
    bounds_framebuffers_[i] = make_framebuffer({bounds_[i].id()});
  }
  transmittances_ = make_target(blended_format_, size_.x, size_.y);
  transmittance_framebuffers_ = make_splat_framebuffers({transmittances_.id()}, target);
}

void SplatMeasures::draw(const Frame& frame, FrameTarget& target) {
  splats_.prepare(frame);
  switch (what_) {
    case SplatMeasure::sums:
      measure_sums(frame, target);
      break;
    case SplatMeasure::median_depth:
      measure_median_depth(frame, target);
      break;
    case SplatMeasure::counts:
      count(frame, target);
      break;
  }
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
}

void SplatMeasures::measure_sums(const Frame& frame, FrameTarget& target) {
  constexpr GLfloat nothing[4] = {0, 0, 0, 0};
  splats_.begin(target, result_framebuffers_, glm::vec4(0.0f));
  glClearBufferfv(GL_COLOR, 1, nothing);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  splats_.draw(frame, target, result_framebuffers_, {.output = SplatOutput::sums});
}

/// Leaves the ranges in bounds_[0]. They end with the splat at which the transmittance falls to
/// `threshold` or below, or beyond all splats.
void SplatMeasures::search(const Frame& frame, FrameTarget& target, float threshold) {
  const GLuint all[4] = {0, splats_.count() + 1, 0, 0};
  glBindFramebuffer(GL_FRAMEBUFFER, bounds_framebuffers_[0].id());
  glClearBufferuiv(GL_COLOR, 0, all);
  for (std::uint32_t range = all[1]; range > 1; range = (range + parts - 1) / parts) {
    splats_.begin(target, transmittance_framebuffers_, glm::vec4(1.0f));
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ZERO, GL_ONE_MINUS_SRC_COLOR);
    splats_.draw(frame, target, transmittance_framebuffers_,
                 {.output = SplatOutput::prefixes, .bounds = bounds_[0].id()});
    gl::use_plain_rasterisation(size_.x, size_.y);
    glDisable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, bounds_framebuffers_[1].id());
    narrow_.use();
    narrow_.set_texture("bounds", 0, bounds_[0].id());
    narrow_.set_texture("transmittances", 1, transmittances_.id());
    narrow_.set("threshold", threshold);
    full_screen_.draw(narrow_);
    std::swap(bounds_[0], bounds_[1]);
    std::swap(bounds_framebuffers_[0], bounds_framebuffers_[1]);
  }
}

void SplatMeasures::measure_median_depth(const Frame& frame, FrameTarget& target) {
  search(frame, target, 0.5f);
  splats_.begin(target, result_framebuffers_, glm::vec4(0.0f));
  splats_.draw(frame, target, result_framebuffers_,
               {.output = SplatOutput::depth_found, .bounds = bounds_[0].id()});
}

void SplatMeasures::count(const Frame& frame, FrameTarget& target) {
  search(frame, target, closed_transmittance);
  splats_.begin(target, result_framebuffers_, glm::vec4(0, 0, 0, 1e30f));
  glEnable(GL_BLEND);
  glBlendEquationSeparate(GL_FUNC_ADD, GL_MIN);
  glBlendFunc(GL_ONE, GL_ONE);
  splats_.draw(frame, target, result_framebuffers_,
               {.output = SplatOutput::counts, .bounds = bounds_[0].id()});
}

std::size_t SplatMeasures::target_bytes() const {
  const std::size_t blended = bytes_of(blended_format_, size_);
  if (what_ == SplatMeasure::sums) return 2 * blended;
  const std::size_t result =
      what_ == SplatMeasure::median_depth ? bytes_of(target_formats::rgba32f, size_) : blended;
  return result + blended + 2 * bytes_of(target_formats::rg32ui, size_);
}

void SplatMeasures::leave_context() {
  full_screen_.leave_context();
  result_framebuffers_ = {};
  transmittance_framebuffers_ = {};
  for (gl::Framebuffer& framebuffer : bounds_framebuffers_) framebuffer = {};
}

}  // namespace tureen
