// What is odd about a soup that can nevertheless be drawn: it costs, or shows nothing, or hints at
// a trainer's or an exporter's mistake. O(data).
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
    /// Vertices with a coordinate that is NaN or infinite. Faces that use one are not drawn and
    /// counted in none of the other findings.
    non_finite_vertices,
    /// No area: the cross product of two edges is below 1e-12 of the longest edge squared.
    degenerate_faces,
    /// The same three corners, bit by bit and in any order, as a face before: one of the two can
    /// never show (in the same order the lower index wins every pixel). The degenerate are not
    /// counted again.
    duplicate_faces,
    /// Alpha below alpha_threshold (or the material's own) everywhere on the face. Sufficient, for
    /// UV textures not necessary: there the bound is that of the whole image.
    never_visible_faces,
    /// Vertices that no face names.
    unused_vertices,
    /// Lint::extent_over_offset is below 2e-4, where the steps of a 32 bit float become visible:
    /// use Scene::origin.
    far_from_origin
  };
  /// Those that count faces or vertices.
  static constexpr std::array counted{Id::non_finite_vertices, Id::degenerate_faces,
                                      Id::duplicate_faces, Id::never_visible_faces,
                                      Id::unused_vertices};
  static constexpr std::size_t shown = 5;

  Id id{};
  std::size_t count = 0;                  // of faces or vertices
  std::size_t of = 0;                     // how many the soup has
  std::vector<std::uint32_t> first = {};  // the lowest few of their indices, `shown` at most
  double extent_over_offset = 0;          // of far_from_origin
};

/// As JSON spells it: "duplicate_faces".
const char* name_of(LintFinding::Id id);

/// A sentence for people.
std::string describe(const LintFinding& finding);

struct Lint {
  std::vector<LintFinding> findings;  // in the order of their ids; empty for a clean soup
  /// The soup's extent (the diagonal of its bounds) over its largest coordinate; 0 where that is 0.
  double extent_over_offset = 0;

  /// The finding, or null.
  const LintFinding* find(LintFinding::Id id) const;
};

/// The soup has no defect().
Lint lint(const TriangleSoup& soup);

}  // namespace tureen
