// The composition: a tureen on its platter and a lace doily, lemons, a branch, on a round table.
#pragma once

#include "examples/surface.hpp"

namespace tureen::example {

/// y is up, the table's top is y = 0, its radius table_radius; the tureen stands in the middle.
Model still_life();

inline constexpr double table_radius = 2.35;

}  // namespace tureen::example
