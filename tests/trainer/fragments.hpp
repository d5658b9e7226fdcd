// All fragments of a triangle, one by one: the reference for kernels that find them in vectors.
#pragma once

#include <algorithm>

#include "trainer/common/kernels/fragments.hpp"

namespace tureen::trainer::test {

/// Calls visit(Fragment) row by row. Pixels whose centre lies on an edge belong to the triangle.
/// `view` supplies the near and the far plane.
template <class Visitor>
void for_each_fragment(const kernels::View& view, const kernels::ProjectedFace& face,
                       const kernels::Rectangle& within, Visitor&& visit) {
  kernels::Fragment fragment;
  for (int y = std::max<int>(face.y0, within.y0); y < std::min<int>(face.y1, within.y1); ++y)
    for (int x = std::max<int>(face.x0, within.x0); x < std::min<int>(face.x1, within.x1); ++x)
      if (kernels::fragment_at(view, face, x, y, fragment)) visit(fragment);
}

}  // namespace tureen::trainer::test
