// Images of specialised plans: four views of a soup with two plans, and their difference.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {

inline constexpr int view_width = 320, view_height = 240;

/// Views of the unit ball, from random directions.
inline std::vector<Camera> four_views(std::uint64_t seed) {
  Random random(seed);
  std::vector<Camera> views;
  for (int i = 0; i < 4; ++i) views.push_back(random_camera(random, view_width, view_height));
  return views;
}

/// One image per view, over white.
inline std::vector<Image8> images(const TriangleSoup& soup, const std::vector<Camera>& views,
                                  const PlanPreferences& plan) {
  static gl::Context context = gl::Context::create(osmesa);
  context.make_current();
  Renderer renderer =
      renderer_of(context, soup, glm::dvec3(0.0), {.plan = plan, .background = glm::vec4(1.0f)});
  std::vector<Image8> images;
  for (const Camera& view : views) {
    renderer.draw({view});
    images.push_back(renderer.read_color());
  }
  return images;
}

struct Difference {
  int largest = 0;           // steps of 8 bits
  std::size_t channels = 0;  // that differ, in all images
  std::size_t all_channels = 0;
  /// The smallest fraction of an image of `a` that is not background.
  double covered = 1.0;
};

inline Difference difference(const std::vector<Image8>& a, const std::vector<Image8>& b) {
  Difference result;
  for (std::size_t view = 0; view < a.size(); ++view) {
    const auto &pixels = a[view].pixels, &others = b[view].pixels;
    result.all_channels += 4 * pixels.size();
    std::size_t covered = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      covered += pixels[i] != glm::u8vec4(255) ? 1 : 0;
      for (int c = 0; c < 4; ++c) {
        const int steps = std::abs(int(pixels[i][c]) - int(others[i][c]));
        result.largest = std::max(result.largest, steps);
        result.channels += steps > 0 ? 1 : 0;
      }
    }
    result.covered = std::min(result.covered, double(covered) / double(pixels.size()));
  }
  return result;
}

/// `what`, and the specialisations that it requires: a network with its weights in uniforms is not
/// analysed, and only faces without an alpha test can have a constant colour.
inline SpecialisationSet alone(Specialisation what) {
  SpecialisationSet set = SpecialisationSet::only(what);
  switch (what) {
    case Specialisation::latent_features:
      set.add(Specialisation::dead_neurons);
      set.add(Specialisation::weight_uniforms);
      break;
    case Specialisation::dead_neurons:
      set.add(Specialisation::weight_uniforms);
      break;
    case Specialisation::interpolation:
    case Specialisation::constant_lattices:
      set.add(Specialisation::alpha_test);
      break;
    default:
      break;
  }
  return set;
}

}  // namespace tureen::test
