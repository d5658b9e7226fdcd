// The arrangement: a tureen on a platter and a lace doily, lemons and branches on a round table.
#pragma once

#include "examples/surface.hpp"

namespace tureen::example {

/// y is up. The table top has the height 0 and the radius table_radius. The tureen is at the
/// origin.
Model still_life();

inline constexpr double table_radius = 2.35;

}  // namespace tureen::example
