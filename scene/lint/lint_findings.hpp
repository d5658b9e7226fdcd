// Counting of lint's findings, for triangles (lint.cpp) and splats (lint_splats.cpp).
#pragma once

#include <cstddef>
#include <initializer_list>

#include "scene/lint/lint.hpp"

namespace tureen {

/// Counts an element; keeps its index if it is among the lowest.
void count(LintFinding& finding, std::size_t index);
/// Moves the findings with a count above 0 to `lint`.
void add_counted(Lint& lint, std::initializer_list<LintFinding*> findings);
/// Sets Lint::extent_over_offset; adds LintFinding::Id::far_from_origin if it is below the limit.
void add_distance_from_origin(Lint& lint, const Bounds& box);

}  // namespace tureen
