#include "runtime/splats/splat_target.hpp"

#include <algorithm>

namespace tureen {

BlendFormat blend_format(SplatFormat requested, const gl::Capabilities& device, float min_alpha,
                         float largest_color) {
  // With fractions of 16 bits, splats vanish where alpha times transmittance is below half a step.
  // From alpha 1/255 on, the colour loses at most half an 8-bit step. Each blending rounds colours
  // to 1/65536 of the largest. If that is 8, roundings of random signs in 200 blendings typically
  // add up to an eighth of an 8-bit step; all in one direction, to 3 steps.
  constexpr float smallest_alpha = 1.0f / 255, largest = 8;
  const bool fits = device.norm16_targets && largest_color <= largest;
  if (fits && (requested == SplatFormat::rgba16 ||
               (requested == SplatFormat::automatic && min_alpha >= smallest_alpha)))
    return {target_formats::rgba16, 1 / std::max(1.0f, largest_color)};
  if (requested != SplatFormat::rgba16f && device.float_blending) return {target_formats::rgba32f};
  return {target_formats::rgba16f};
}

SplatTarget::SplatTarget(gl::Api api, const BlendFormat& format) : api_(api), format_(format) {}

void SplatTarget::resize(glm::ivec2 size) {
  size_ = size;
  blended_ = make_target(format_.texture, size.x, size.y);
  behind_ = {};
  behind_framebuffer_ = {};
}

void SplatTarget::composite_over(FrameTarget& target) {
  const bool has_color = target.has_color();
  if (has_color && !behind_) {
    behind_ = make_target(target_formats::rgba8, size_.x, size_.y);
    behind_framebuffer_ = make_framebuffer({behind_.id()});
  }
  if (has_color) blit_color(target.color_framebuffer(), behind_framebuffer_.id(), size_);
  target.overwrite_color();
  std::optional<gl::Program>& resolve = has_color ? over_colors_ : over_background_;
  if (!resolve)
    resolve = full_screen_program(
        {.file = "splat_resolve.frag", .constants = {{"OVER_COLORS", has_color ? "1" : "0"}}},
        api_);
  resolve->use();
  resolve->set_texture("splats", 0, blended_.id());
  resolve->set("color_unit", format_.color_unit);
  if (has_color)
    resolve->set_texture("behind", 1, behind_.id());
  else
    resolve->set("background", target.background());
  full_screen_.draw(*resolve);
}

std::vector<glm::vec4> SplatTarget::read(const gl::Framebuffer& framebuffer) const {
  const auto read =
      format_.texture.type == GL_UNSIGNED_SHORT ? read_fraction_pixels : read_float_pixels;
  std::vector<glm::vec4> pixels = read(framebuffer.id(), size_);
  for (glm::vec4& pixel : pixels) pixel = {glm::vec3(pixel) / format_.color_unit, pixel.a};
  return pixels;
}

std::size_t SplatTarget::bytes() const {
  return bytes_of(format_.texture, size_) + (behind_ ? bytes_of(target_formats::rgba8, size_) : 0);
}

void SplatTarget::leave_context() {
  full_screen_.leave_context();
  behind_ = {};
  behind_framebuffer_ = {};
}

}  // namespace tureen
