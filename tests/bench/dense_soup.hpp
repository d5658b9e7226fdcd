// A large soup out of a small one, always the same: for loading and for frames.
#pragma once

#include <cstddef>

#include "scene/triangle_soup.hpp"

namespace tureen::test {

/// Splits every triangle of `base` at its edges' midpoints into four, again and again, until there
/// are at least `triangles`. Vertices are unshared and each is moved by up to 2 % of its triangle's
/// longest edge; colours are those of `base` (grey where it has none) varied by up to 24 / 255 a
/// triangle, bytes / 255, alpha 1: nothing merges and every format holds it exactly.
TriangleSoup dense_soup(const TriangleSoup& base, std::size_t triangles);

}  // namespace tureen::test
