// A soup with fewer faces.
#pragma once

#include <cstdint>
#include <span>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// The faces with a nonzero entry in `keeps` (one a face), in their order. Unused vertices and
/// lattice texels are removed with their data; materials and images stay. Shared texels stay
/// shared.
TriangleSoup keep_faces(TriangleSoup soup, std::span<const std::uint8_t> keeps);

}  // namespace tureen
