// Splats along the Morton curve (G. M. Morton, "A Computer Oriented Geodetic Data Base", 1966), so
// that neighbours in space are near each other in memory, and consecutive splats have small bounds.
#pragma once

#include <cstddef>

#include "scene/splats.hpp"

namespace tureen {

/// Sorts the splats, with their colours, by the Morton code of their centres: 21 bits an axis over
/// the smallest cube around all finite centres; x has the lowest bit. Stable: splats of one code
/// keep their order. Splats with a centre that is not finite come last. At most 2^32 - 1 splats.
void sort_in_morton_order(Splats& splats);

/// Temporary memory of sort_in_morton_order, in bytes.
std::size_t morton_order_bytes(const Splats& splats);

}  // namespace tureen
