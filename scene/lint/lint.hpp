// Suspicious properties of a drawable soup or of splats: wasted cost, invisible content, or signs
// of a mistake of a trainer or exporter. O(n log n).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/splats.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct LintFinding {
  enum class Id {
    /// Vertices with a NaN or infinite coordinate. Faces with such a vertex are not drawn and not
    /// counted in the other findings.
    non_finite_vertices,
    /// No area: the cross product of two edges is below 1e-12 of the longest edge squared.
    degenerate_faces,
    /// Faces with exactly the same three corners, in any order, as an earlier face. Where both
    /// faces are opaque, only one is visible. If their corners have the same order, the face with
    /// the lower index is visible; otherwise rounding can decide. Degenerate faces are not counted
    /// here.
    duplicate_faces,
    /// Faces with alpha below alpha_threshold (or the material's own threshold) everywhere. For UV
    /// textures the bound uses the whole image, so some invisible faces are not found.
    never_visible_faces,
    /// Vertices without a face.
    unused_vertices,
    /// Lint::extent_over_offset is below 2e-4, where steps of 32-bit floats become visible. To
    /// avoid this, store coordinates relative to a near point, and put that point into
    /// Layer::world_from_layer.
    far_from_origin,
    /// Splats whose opacity is below SplatProfile::min_alpha: they are never drawn. Those of neural
    /// densities depend on the view and are not counted.
    transparent_splats,
    /// Gaussians with a scale of 0, of flat ones x or y; windows without area, by the rule of
    /// degenerate_faces. Some low passes still draw them as lines or dots.
    collapsed_splats,
    /// Splats that are more than `needle_aspect` times as long as they are wide: an error of the
    /// trainer, and rounding shows. Collapsed ones are not counted.
    needle_splats,
    /// Splats whose centre is more than 10 times as far from the median centre as nine tenths of
    /// the centres, or whose largest scale (of a window, its extent) is above the distance of nine
    /// tenths. They cover much of every image, and enlarge the box into which views fit.
    outlying_splats,
    /// Splats with exactly the shape and place of an earlier one.
    duplicate_splats,
    /// The near limit is so large that usual views lose splats: scene/near_limit.hpp.
    large_near_limit,
    /// Harmonics coefficients that are 0 for all splats, from a degree on: the file can omit them.
    /// Counts coefficients, not splats.
    zero_harmonics
  };
  /// The ids that count faces or vertices of a soup.
  static constexpr std::array counted{Id::non_finite_vertices, Id::degenerate_faces,
                                      Id::duplicate_faces, Id::never_visible_faces,
                                      Id::unused_vertices};
  /// The ids that count splats, or their coefficients.
  static constexpr std::array counted_of_splats{Id::transparent_splats, Id::collapsed_splats,
                                                Id::needle_splats,      Id::outlying_splats,
                                                Id::duplicate_splats,   Id::zero_harmonics};
  /// At this aspect, roundings of floats change the alpha of a Gaussian by half an 8-bit step
  /// (docs/numerics.md, E1).
  static constexpr double needle_aspect = 2000;
  static constexpr std::size_t shown = 5;

  Id id{};
  std::size_t count = 0;  // number of faces, vertices, .. found
  std::size_t of = 0;     // number in the soup or the splats
  /// The lowest indices found, at most `shown`; of splats with Splats::rows, the lowest rows.
  std::vector<std::uint32_t> first = {};
  double extent_over_offset = 0;  // for far_from_origin
};

/// The id's name in JSON: "duplicate_faces".
const char* name_of(LintFinding::Id id);

/// A sentence in English.
std::string describe(const LintFinding& finding);

struct Lint {
  std::vector<LintFinding> findings;  // in the order of their ids; empty for a clean soup
  /// The diagonal of the bounds divided by the largest absolute coordinate; 0 if all coordinates
  /// are 0.
  double extent_over_offset = 0;

  /// The finding, or null.
  const LintFinding* find(LintFinding::Id id) const;
};

/// Finds the suspicious properties of a soup, or of splats. They must have no defect().
Lint lint(const TriangleSoup& soup);
Lint lint(const Splats& splats);

}  // namespace tureen
