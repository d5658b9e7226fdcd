// Drawing with quality settings, shared by several tests.
#pragma once

#include "runtime/renderer.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {

inline PlanPreferences with(const Quality& quality) { return {.site = {}, .quality = quality}; }

inline RenderOptions options_with(const Quality& quality) {
  return {.plan = with(quality), .limits = {}};
}

inline TriangleSoup soup_of(Kind kind) {
  return random_soup(21, {.kind = kind, .faces = 80, .size = 0.3, .degree = 1});
}

inline Camera camera_of(int width, int height) {
  Random random(21);
  return random_camera(random, width, height);
}

inline Image8 draw(const gl::Context& context, const TriangleSoup& soup, const Camera& camera,
                   const RenderOptions& options) {
  Renderer renderer = renderer_of(context, soup, {}, options);
  renderer.draw({camera});
  return renderer.read_color();
}

}  // namespace tureen::test
