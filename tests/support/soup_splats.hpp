// Triangles as splats that cover about the same places, for images of every kernel.
#pragma once

#include "scene/splats.hpp"
#include "scene/triangle_soup.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {

/// One splat for each triangle, with its mean colour. Windows are the triangles, twice as large.
/// Discs and neural densities lie in their planes and have their moments. `kind.kernel` is not
/// `gaussians`. Triangles without area are dropped.
Splats splats_of(const TriangleSoup& soup, const SplatKind& kind);

}  // namespace tureen::test
