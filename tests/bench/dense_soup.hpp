// A large soup made from a small one, for benchmarks of loading and frames. Deterministic.
#pragma once

#include <cstddef>

#include "scene/triangle_soup.hpp"

namespace tureen::test {

/// Splits every triangle of `base` at its edges' midpoints into four, repeatedly, until there are
/// at least `triangles`. Vertices are not shared; each is moved by up to 2 % of its triangle's
/// longest edge. Colours are those of `base` (grey if it has none), varied by up to 24 / 255 per
/// triangle, as bytes / 255, with alpha 1. Thus no vertices merge, and every format stores the soup
/// exactly.
TriangleSoup dense_soup(const TriangleSoup& base, std::size_t triangles);

}  // namespace tureen::test
