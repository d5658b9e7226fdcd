#include "runtime/splats/hidden_tiles.hpp"

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

/// For the bound texture: which of its levels are read.
void read_levels(int first, int last) {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, first);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, last);
}

}  // namespace

HiddenTiles::HiddenTiles(gl::Api api, float largest_color)
    : min_alpha_(1 - 1 / (510 * largest_color)),
      from_pixels_(
          full_screen_program({.file = "splat_hidden_tiles.frag",
                               .constants = {{"FROM_PIXELS", "1"}, {"SIDE", std::to_string(side)}}},
                              api)),
      from_tiles_(full_screen_program(
          {.file = "splat_hidden_tiles.frag", .constants = {{"FROM_PIXELS", "0"}, {"SIDE", "2"}}},
          api)) {}

glm::ivec2 HiddenTiles::size_of(int level) const { return tile_count_ / (1 << level); }

void HiddenTiles::resize(glm::ivec2 size) {
  size_ = size;
  // A multiple of the coarsest tiles.
  constexpr int coarsest = side << (levels - 1);
  tile_count_ = (size + coarsest - 1) / coarsest * (coarsest / side);
  tiles_ = make_target(target_formats::r8, tile_count_.x, tile_count_.y);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  for (int level = 1; level < levels; ++level)
    glTexImage2D(GL_TEXTURE_2D, level, GL_R8, size_of(level).x, size_of(level).y, 0, GL_RED,
                 GL_UNSIGNED_BYTE, nullptr);
  read_levels(0, levels - 1);
  framebuffers_.clear();
  for (int level = 0; level < levels; ++level) {
    framebuffers_.push_back(gl::Framebuffer::create());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_.back().id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, tiles_.id(), level);
    require_complete_framebuffer();
  }
}

void HiddenTiles::find(GLuint blended) {
  // A level that is drawn may not be one that is read; in WebGL, it must be in the range of levels.
  // So the range has both, and without mipmaps only its first level is read.
  glBindTexture(GL_TEXTURE_2D, tiles_.id());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  for (int level = 0; level < levels; ++level) {
    const gl::Program& program = level == 0 ? from_pixels_ : from_tiles_;
    gl::use_plain_rasterisation(size_of(level).x, size_of(level).y);
    glDisable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[std::size_t(level)].id());
    program.use();
    program.set_texture("finer", 0, level == 0 ? blended : tiles_.id());
    if (level > 0) read_levels(level - 1, level);
    program.set("finer_size", level == 0 ? size_ : size_of(level - 1));
    program.set("min_alpha", min_alpha_);
    full_screen_.draw(program);
  }
  glBindTexture(GL_TEXTURE_2D, tiles_.id());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  read_levels(0, levels - 1);
}

std::size_t HiddenTiles::bytes() const {
  // The further levels add a third.
  return bytes_of(target_formats::r8, tile_count_) * 4 / 3;
}

void HiddenTiles::leave_context() {
  full_screen_.leave_context();
  framebuffers_.clear();
}

}  // namespace tureen
