// A soup with fewer faces.
#pragma once

#include <cstdint>
#include <span>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// The faces whose entry of `keeps`, one a face, is not 0, in their order. Vertices and lattice
/// texels that nothing uses any longer are left out with all that belongs to them; materials and
/// images stay. Texels that faces share stay shared.
TriangleSoup keep_faces(const TriangleSoup& soup, std::span<const std::uint8_t> keeps);

}  // namespace tureen
