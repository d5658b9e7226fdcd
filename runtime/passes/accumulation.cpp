#include "runtime/passes/accumulation.hpp"

#include <cassert>

#include "runtime/gl/state.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

/// Frames along each axis: even, so that every position has its opposite.
int frames_per_axis(int supersampling) {
  int frames = 2;
  while (frames * supersampling < samples_at_rest) frames += 2;
  return frames;
}

}  // namespace

int frames_at_rest(int supersampling) {
  if (supersampling >= samples_at_rest) return 0;
  const int side = frames_per_axis(supersampling);
  return side * side;
}

glm::dvec2 position_at_rest(int index, int supersampling) {
  // Four positions are those of a quadrant's cell, turned by quarters of a circle. The cells follow
  // in steps of 7, which has no factor in common with 1, 4 and 16 cells, so that early ones spread.
  const int side = frames_per_axis(supersampling), half = side / 2;
  const int cell = (6 + 7 * (index / 4)) % (half * half);
  const glm::dvec2 at(2 * (cell % half) + 1, 2 * (cell / half) + 1);
  const glm::dvec2 turned[] = {at, -at, {-at.y, at.x}, {at.y, -at.x}};
  return turned[index % 4] / double(2 * side * supersampling);
}

Accumulation::Accumulation(gl::Api api)
    : adding_(full_screen_program({.file = "accumulate.frag"}, api)),
      dividing_(full_screen_program({.file = "accumulated.frag"}, api)) {}

void Accumulation::begin(glm::ivec2 size, GLuint framebuffer, int frames) {
  assert(frames > 0 && frames % 4 == 0);
  forget();
  gl::use_plain_rasterisation(size.x, size.y);  // clearing depends on masks
  if (size != size_ || !image_) {
    size_ = size;
    image_framebuffer_ = {};
    image_ = make_target(target_formats::rgba8, size.x, size.y);
    image_framebuffer_ = make_framebuffer({image_.id()});
  }
  for (int i = 0; i < 2; ++i) {
    sums_[i] = make_target(target_formats::rgba32f, size.x, size.y);
    sum_framebuffers_[i] = make_framebuffer({sums_[i].id()});
  }
  // The first frame reads the second sum.
  const glm::vec4 nothing(0.0f);
  glClearBufferfv(GL_COLOR, 0, &nothing[0]);
  blit_color(framebuffer, image_framebuffer_.id(), size);
  wanted_ = frames;
}

void Accumulation::add(GLuint image, const glm::vec4& background) {
  assert(!complete());
  const int to = added_ % 2, from = 1 - to;
  gl::use_plain_rasterisation(size_.x, size_.y);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, sum_framebuffers_[to].id());
  adding_.use();
  adding_.set_texture("image", 0, image);
  adding_.set_texture("sum", 1, sums_[from].id());
  full_screen_.draw(adding_);
  if (++added_ % 4 != 0) return;
  glBindFramebuffer(GL_FRAMEBUFFER, image_framebuffer_.id());
  dividing_.use();
  dividing_.set_texture("sum", 0, sums_[to].id());
  dividing_.set("share", 1.0f / float(added_));
  dividing_.set("background", background);
  full_screen_.draw(dividing_);
  if (complete()) free_sums();
}

void Accumulation::forget() {
  added_ = 0;
  free_sums();
}

void Accumulation::free_sums() {
  for (int i = 0; i < 2; ++i) {
    sum_framebuffers_[i] = {};
    sums_[i] = {};
  }
}

std::size_t Accumulation::bytes() const {
  std::size_t bytes = image_ ? bytes_of(target_formats::rgba8, size_) : 0;
  for (const gl::Texture& sum : sums_)
    if (sum) bytes += bytes_of(target_formats::rgba32f, size_);
  return bytes;
}

}  // namespace tureen
