// Checks behind the transparent parts of the window's image.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "runtime/gl/program.hpp"
#include "runtime/passes/full_screen.hpp"

namespace tureen::viewer {

class Checks {
 public:
  /// Draws them under the image in the lower left corner of the window's framebuffer, whose colours
  /// are not premultiplied; afterwards it is opaque. Without alpha in the framebuffer, as a few
  /// systems have it, nothing changes. `size`: of the image, `side`: of a check, in pixels.
  void draw(gl::Api api, glm::ivec2 size, double side);

 private:
  std::optional<gl::Program> program_;
  FullScreen full_screen_;
};

}  // namespace tureen::viewer
