#include "runtime/passes/fragment_store.hpp"

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

FragmentStore::FragmentStore(int width, int height, GLuint depth)
    : visible_(make_target(target_formats::rg32ui, width, height)),
      framebuffer_(make_framebuffer({visible_.id()}, depth)) {}

void FragmentStore::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  const GLuint empty[4] = {no_face, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, empty);
}

void FragmentStore::bind(const gl::Program& program, int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, visible_.id());
  gl::use_texture_sampling(static_cast<unsigned>(unit));
  program.set("visible", unit);
}

std::size_t FragmentStore::bytes(glm::ivec2 size) { return bytes_of(target_formats::rg32ui, size); }

}  // namespace tureen
