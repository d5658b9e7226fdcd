// Projected discs for compositing, and the tiles that they touch.
#pragma once

#include "splatting/discs/disc_kernels.hpp"

namespace tureen::splatting {

/// Reads disc `i` of rows of projected_disc_row.
DiscEntry disc_entry(const ParameterRows& projected, std::size_t i);
/// The box outside of which its alpha is below the smallest.
Box disc_box(const ParameterRows& projected, std::size_t i);

}  // namespace tureen::splatting
