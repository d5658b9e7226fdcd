// Lattice textures with fewer texels: every face at a level of its own choice or under a common
// cap, projected as scene/edit/lattice_projection.hpp says.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// What a lower level may cost on any one face. Only what shows is compared: the first three
/// features where there is no color MLP, all seven where there is one.
struct LevelTolerance {
  /// The largest error of a feature anywhere on the face. The default is half a step of 8 bits.
  double largest = 0.5 / 255;
  /// The root of the mean square over the face, of all features together.
  double root_mean_square = std::numeric_limits<double>::infinity();
  /// The fraction of the face where the cut-out differs. The default is where none was found.
  double coverage = 0.0;
};

/// Called now and then with the fraction done, 0..1; may throw to abandon the work.
using LevelProgress = std::function<void(double)>;

/// The smallest level of each face, at most its own, whose projection keeps within the tolerance,
/// before it is rounded to bytes. A face that is transparent throughout has level 0.
std::vector<std::uint8_t> smallest_levels(const LatticeTexture& texture,
                                          const LevelTolerance& tolerance = {},
                                          const LevelProgress& progress = {});

/// The texture with each face at its level of `levels`, one a face, none above the face's own;
/// bytes stay bytes. Features are clamped to [0, 1]. A face at its own level keeps its texels to
/// the bit, and faces that share all of their texels go on sharing them where their levels agree.
/// Values that are not finite count as 0 where they are projected. Throws UsageError where texels
/// that faces share in part would become more than 32 bits can number.
LatticeTexture at_levels(const LatticeTexture& texture, std::span<const std::uint8_t> levels,
                         const LevelProgress& progress = {});

/// The same with no face above `level`.
LatticeTexture at_most_level(const LatticeTexture& texture, int level,
                             const LevelProgress& progress = {});

}  // namespace tureen
