// A soup with a known cost: layers behind each other that fill the same part of an image.
// Triangles, fragments and shaded pixels can be set separately.
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/scene.hpp"

namespace tureen::test {

struct LayeredSoupOptions {
  /// Minimum; cells of a regular grid have two triangles each, so there are a few more.
  std::size_t triangles = 65536;
  int layers = 4;
  /// Opaque with a colour per face, or cut out: a lattice of level 1 with random features and
  /// alpha, and a random color MLP.
  enum class Kind { opaque, cut_out } kind = Kind::opaque;
  std::uint64_t seed = 1;
};

/// The fraction of a 16:9 image's width and height that a layer covers: a frame has fill^2 * pixels
/// * layers fragments. tests/measure.py has the same number.
inline constexpr double layered_soup_fill = 0.8;

/// The layers face a single camera of 1280 x 720 (see resized()). Triangles are in random order and
/// share no vertices.
Scene layered_soup(const LayeredSoupOptions& options = {});

}  // namespace tureen::test
