// Lattice textures with fewer texels: each face at its own level or under a common maximum, by the
// projection in scene/edit/lattice_projection.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// The largest loss on any one face when its level is reduced. Only visible features are compared:
/// the first three without a color MLP, all seven with one.
struct LevelTolerance {
  /// The largest error of a feature anywhere on the face. The default is half a step of 8 bits.
  double largest = 0.5 / 255;
  /// The root mean square error over the face and all features together.
  double root_mean_square = std::numeric_limits<double>::infinity();
  /// The fraction of the face with a different cut-out. The default accepts no measured difference.
  double coverage = 0.0;
};

/// Called with the fraction done, 0..1; may throw to cancel.
using LevelProgress = std::function<void(double)>;

/// The smallest level of each face, at most its own, whose projection is within the tolerance
/// before rounding to bytes. A fully transparent face has level 0.
std::vector<std::uint8_t> smallest_levels(const LatticeTexture& texture,
                                          const LevelTolerance& tolerance = {},
                                          const LevelProgress& progress = {});

/// The texture with each face at its level in `levels` (one a face, at most the face's own level).
/// Bytes stay bytes. Features are clamped to [0, 1]. A face at its own level keeps its texels
/// exactly. Faces that share all of their texels continue to share them if their levels agree.
/// Projection counts values that are not finite as 0. Throws UsageError if partly shared texels
/// would exceed 2^32.
LatticeTexture at_levels(const LatticeTexture& texture, std::span<const std::uint8_t> levels,
                         const LevelProgress& progress = {});

/// The same with the level of every face limited to `level`.
LatticeTexture at_most_level(const LatticeTexture& texture, int level,
                             const LevelProgress& progress = {});

}  // namespace tureen
