#include "runtime/passes/filter_pass.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/passes/shader_source.hpp"

namespace tureen {

namespace {

ShaderSource filter_of(const Quality& quality) {
  if (quality.resolution_scale < 1) return {.file = "upscale.frag"};
  return {.file = "box_filter.frag",
          .constants = {{"SAMPLES_PER_AXIS", std::to_string(quality.supersampling)}}};
}

}  // namespace

int scaled_size(int size, double scale) {
  return std::max(1, static_cast<int>(std::lround(size * scale)));
}

glm::ivec2 sample_size(const Quality& quality, glm::ivec2 size) {
  const double scale = quality.resolution_scale;
  if (scale < 1) return {scaled_size(size.x, scale), scaled_size(size.y, scale)};
  return quality.supersampling * size;
}

FilterPass::FilterPass(const Quality& quality, gl::Api api)
    : program_(full_screen_program(filter_of(quality), api)) {}

void FilterPass::resize(const FrameTarget&) {
  color_ = make_target(target_formats::rgba8, size_.x, size_.y);
  framebuffer_ = make_framebuffer({color_.id()});
}

void FilterPass::draw(const Frame&, FrameTarget& target) {
  glViewport(0, 0, size_.x, size_.y);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  program_.use();
  program_.set_texture("samples", 0, target.color_texture());
  program_.set("samples_per_pixel", glm::vec2(target.size()) / glm::vec2(size_));
  full_screen_.draw(program_);
}

std::size_t FilterPass::target_bytes() const { return bytes_of(target_formats::rgba8, size_); }

void FilterPass::leave_context() {
  full_screen_.leave_context();
  framebuffer_ = {};
}

}  // namespace tureen
