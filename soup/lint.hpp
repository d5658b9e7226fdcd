// What is odd about a soup that can nevertheless be drawn: it costs, or shows nothing, or hints at
// a trainer's or an exporter's mistake. O(data).
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "soup/triangle_soup.hpp"

namespace tureen {

/// How many faces (or vertices), and the lowest few of their indices.
struct LintFinding {
  static constexpr std::size_t shown = 5;
  std::size_t count = 0;
  std::vector<std::uint32_t> first;
};

struct Lint {
  /// Vertices with a coordinate that is NaN or infinite. Faces that use one are not drawn and
  /// counted in none of the other findings.
  LintFinding non_finite_vertices;
  /// No area: the cross product of two edges is below 1e-12 of the longest edge squared.
  LintFinding degenerate_faces;
  /// The same three corners, bit by bit and in any order, as a face before: one of the two can
  /// never show (in the same order the lower index wins every pixel). The degenerate are not
  /// counted again.
  LintFinding duplicate_faces;
  /// Alpha below alpha_threshold (or the material's own) everywhere on the face. Sufficient, for
  /// UV textures not necessary: there the bound is that of the whole image.
  LintFinding never_visible_faces;
  /// Vertices that no face names.
  LintFinding unused_vertices;
  /// The soup's extent (the diagonal of its bounds) over its largest coordinate. Below 2e-4 the
  /// steps of a 32 bit float become visible: use Scene::origin.
  double extent_over_offset = 0;
  bool far_from_origin = false;

  /// For people, one a finding; empty for a clean soup.
  std::vector<std::string> sentences;
};

/// The soup has no defect().
Lint lint(const TriangleSoup& soup);

}  // namespace tureen
