#include "runtime/passes/motion.hpp"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "runtime/gl/state.hpp"
#include "runtime/passes/accumulation.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

/// Sample positions in turn: the first 16 of those at rest are spread over the pixel.
constexpr unsigned positions = 16;

/// The part of the newest frame in the image: the mean then has the weight of about 2 / share - 1
/// frames.
constexpr float share = 0.25f;

/// Coefficients of 1 / distance = x + y * depth. It is affine in every storage (clip_from_view).
glm::vec2 inverse_distance(const ClipRange& range, DepthStorage storage) {
  const double at_low = 1 / distance_of(0.25, range, storage).value(),
               at_high = 1 / distance_of(0.75, range, storage).value();
  return {1.5 * at_low - 0.5 * at_high, 2 * (at_high - at_low)};
}

}  // namespace

Motion::Motion(gl::Api api)
    : program_(assemble({.file = "full_screen.vert"}, api), assemble({.file = "motion.frag"}, api)) {
}

glm::dvec2 Motion::position() const { return position_at_rest(int(frames_ % positions), 1); }

void Motion::add(GLuint color, GLuint depth, glm::ivec2 size, const Camera& camera,
                 const ClipRange& range, DepthStorage storage) {
  if (size != size_ || !images_[0]) {
    before_.reset();
    for (int i = 0; i < 2; ++i) {
      images_[i] = make_target(target_formats::rgba8, size.x, size.y);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
      framebuffers_[i] = make_framebuffer({images_[i].id()});
    }
    size_ = size;
  }
  const Camera& before = before_ ? *before_ : camera;
  const glm::dmat4 before_from_now = before.view_from_world * glm::inverse(camera.view_from_world);
  const int to = 1 - newest_;
  gl::use_plain_rasterisation(size.x, size.y);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[to].id());
  program_.use();
  program_.set_texture("image", 0, color);
  program_.set_texture("depth", 1, depth);
  program_.set_texture("earlier", 2, images_[newest_].id());
  program_.set("inverse_distance", inverse_distance(range, storage));
  // Row 0 of gl_FragCoord is the lowest, that of a camera the highest.
  const double h = size.y;
  program_.set("ray_of_pixel", glm::vec4(1 / camera.fx, 1 / camera.fy, -camera.cx / camera.fx,
                                         (camera.cy - h) / camera.fy));
  program_.set("turn", glm::mat3(before_from_now));
  program_.set("shift", glm::vec3(before_from_now[3]));
  program_.set("place_of_ray",
               glm::vec4(before.fx / size.x, before.fy / h, before.cx / size.x, 1 - before.cy / h));
  program_.set("share", before_ ? share : 1.0f);
  full_screen_.draw(program_);
  glEnable(GL_DEPTH_TEST);
  newest_ = to;
  before_ = camera;
  ++frames_;
}

std::size_t Motion::bytes() const {
  return images_[0] ? 2 * bytes_of(target_formats::rgba8, size_) : 0;
}

}  // namespace tureen
