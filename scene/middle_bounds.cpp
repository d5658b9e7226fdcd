#include "scene/middle_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <variant>
#include <vector>

namespace tureen {

namespace {

/// The box around the middle 98 % of the points that visit(add) adds, along each axis; for fewer
/// than 100 points that of bounds(), which is computed only then: for splats it takes as long as
/// the rest.
template <class Primitives, class Visit>
Bounds middle_of(const Primitives& primitives, std::size_t points, const Visit& visit) {
  Bounds result;
  std::vector<float> along;
  along.reserve(points);
  for (int axis = 0; axis < 3; ++axis) {
    along.clear();
    visit([&](const glm::vec3& point) {
      if (std::isfinite(point[axis])) along.push_back(point[axis]);
    });
    const std::size_t cut = along.size() / 100;
    if (cut == 0) {
      const Bounds all = bounds(primitives);
      result.low[axis] = all.low[axis];
      result.high[axis] = all.high[axis];
      continue;
    }
    const auto low = along.begin() + std::ptrdiff_t(cut),
               high = along.end() - 1 - std::ptrdiff_t(cut);
    std::nth_element(along.begin(), low, along.end());
    result.low[axis] = *low;
    std::nth_element(low, high, along.end());
    result.high[axis] = *high;
  }
  return result;
}

}  // namespace

Bounds middle_bounds(const TriangleSoup& soup) {
  return middle_of(soup, 3 * soup.triangles.size(), [&](const auto& add) {
    for (const glm::uvec3& t : soup.triangles)
      for (int k = 0; k < 3; ++k) add(soup.positions[t[k]]);
  });
}

Bounds middle_bounds(const Splats& splats) {
  return middle_of(splats, count(splats), [&](const auto& add) {
    for (std::size_t i = 0; i < count(splats); ++i) add(glm::vec3(center(splats, i)));
  });
}

Bounds framed_bounds(const Splats& splats) {
  const Bounds middle = middle_bounds(splats);
  const glm::vec3 sizes = middle.high - middle.low;
  const float size = std::max({sizes.x, sizes.y, sizes.z});
  const glm::vec3 low = middle.low - size, high = middle.high + size;
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < count(splats); ++i) {
    const glm::vec3 at(center(splats, i));
    if (glm::clamp(at, low, high) == at) near.push_back(std::uint32_t(i));
  }
  const Bounds box = bounds(splats, near, splats.profile);
  if (box.low == box.high) return box;  // nothing is visible
  return {glm::max(box.low, low), glm::min(box.high, high)};
}

Bounds framed_bounds(const Layer& layer) {
  const auto* splats = std::get_if<Splats>(&layer.primitives);
  return splats ? framed_bounds(*splats) : bounds(layer);
}

}  // namespace tureen
