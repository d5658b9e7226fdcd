// Suspicious properties of a drawable soup: wasted cost, invisible content, or signs of a mistake
// of a trainer or exporter. O(data).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

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
    /// faces
    /// are opaque, only one is visible. If their corners have the same order, the face with the
    /// lower index is visible; otherwise rounding can decide. Degenerate faces are not counted
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
    far_from_origin
  };
  /// The ids that count faces or vertices.
  static constexpr std::array counted{Id::non_finite_vertices, Id::degenerate_faces,
                                      Id::duplicate_faces, Id::never_visible_faces,
                                      Id::unused_vertices};
  static constexpr std::size_t shown = 5;

  Id id{};
  std::size_t count = 0;                  // number of faces or vertices found
  std::size_t of = 0;                     // number in the soup
  std::vector<std::uint32_t> first = {};  // the lowest indices found, at most `shown`
  double extent_over_offset = 0;          // for far_from_origin
};

/// The id's name in JSON: "duplicate_faces".
const char* name_of(LintFinding::Id id);

/// A sentence in English.
std::string describe(const LintFinding& finding);

struct Lint {
  std::vector<LintFinding> findings;  // in the order of their ids; empty for a clean soup
  /// The soup's extent (the diagonal of its bounds) divided by its largest absolute coordinate; 0
  /// if all coordinates are 0.
  double extent_over_offset = 0;

  /// The finding, or null.
  const LintFinding* find(LintFinding::Id id) const;
};

/// Finds the suspicious properties of a soup. The soup must have no defect().
Lint lint(const TriangleSoup& soup);

}  // namespace tureen
