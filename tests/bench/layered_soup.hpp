// A soup whose cost is known beforehand: layers behind each other that fill the same part of a
// image, so that triangles, fragments and shaded pixels can be set one by one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/scene.hpp"

namespace tureen::test {

struct LayeredSoupOptions {
  /// At least; two of them make a cell of a regular grid, so it becomes a few more.
  std::size_t triangles = 65536;
  int layers = 4;
  /// Opaque with a colour a face, or cut out: a lattice of level 1 with random features and alpha,
  /// and a random color MLP.
  enum class Kind { opaque, cut_out } kind = Kind::opaque;
  std::uint64_t seed = 1;
};

/// The part of a 16:9 image's width and height that a layer covers: a frame has fill^2 * pixels *
/// layers fragments. tests/measure.py has the same number.
inline constexpr double layered_soup_fill = 0.8;

/// The layers face the one camera, whose size is that of 1280 x 720 (see resized()); the triangles
/// stand in random order and share no vertices.
Scene layered_soup(const LayeredSoupOptions& options = {});

}  // namespace tureen::test
