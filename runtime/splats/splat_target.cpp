#include "runtime/splats/splat_target.hpp"

#include "runtime/passes/shader_source.hpp"

namespace tureen {

SplatTarget::SplatTarget(gl::Api api, const TargetFormat& format)
    : format_(format),
      resolve_(assemble({.file = "full_screen.vert"}, api),
               assemble({.file = "splat_resolve.frag"}, api)) {}

void SplatTarget::resize(glm::ivec2 size) {
  size_ = size;
  blended_ = make_target(format_, size.x, size.y);
  behind_ = make_target(target_formats::rgba8, size.x, size.y);
  behind_framebuffer_ = make_framebuffer({behind_.id()});
}

void SplatTarget::composite_over(FrameTarget& target) {
  target.draw_color();  // clears the colours if no pass has drawn any
  blit_color(target.color_framebuffer(), behind_framebuffer_.id(), size_);
  target.overwrite_color();
  resolve_.use();
  resolve_.set_texture("splats", 0, blended_.id());
  resolve_.set_texture("behind", 1, behind_.id());
  full_screen_.draw(resolve_);
}

std::size_t SplatTarget::bytes() const {
  return bytes_of(format_, size_) + bytes_of(target_formats::rgba8, size_);
}

void SplatTarget::leave_context() {
  full_screen_.leave_context();
  behind_framebuffer_ = {};
}

}  // namespace tureen
