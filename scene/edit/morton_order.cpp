#include "scene/edit/morton_order.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <span>

#include "scene/finite.hpp"

namespace tureen {

namespace {

constexpr int morton_bits = 21;  // an axis; three axes fit in 63 bits

struct MortonKey {
  std::uint64_t code;
  std::uint32_t point;
};

/// The 21 low bits of `value`, each moved to three times its position.
std::uint64_t spread(std::uint64_t value) {
  value = (value | value << 32) & 0x001f00000000ffffu;
  value = (value | value << 16) & 0x001f0000ff0000ffu;
  value = (value | value << 8) & 0x100f00f00f00f00fu;
  value = (value | value << 4) & 0x10c30c30c30c30c3u;
  value = (value | value << 2) & 0x1249249249249249u;
  return value;
}

/// Moves the `each` values of every splat to its new place.
template <class T>
void reorder(std::vector<T>& values, std::size_t each, std::span<const std::uint32_t> order) {
  assert(values.size() == each * order.size());
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::size_t splat : order)
    sorted.insert(sorted.end(), values.begin() + std::ptrdiff_t(each * splat),
                  values.begin() + std::ptrdiff_t(each * (splat + 1)));
  values = std::move(sorted);
}

}  // namespace

std::vector<std::uint32_t> morton_order(std::size_t count,
                                        const std::function<glm::dvec3(std::size_t)>& point) {
  assert(count <= std::numeric_limits<std::uint32_t>::max());
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (std::size_t i = 0; i < count; ++i)
    if (const glm::dvec3 p = point(i); is_finite(p)) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  const glm::dvec3 size = high - low;
  const double edge = std::max({size.x, size.y, size.z});
  const double cells = double(1 << morton_bits);
  std::vector<MortonKey> keys(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 p = point(i);
    std::uint64_t code = std::numeric_limits<std::uint64_t>::max();
    if (is_finite(p)) {
      code = 0;
      for (int axis = 0; axis < 3 && edge > 0; ++axis) {
        const double cell = std::min((p[axis] - low[axis]) / edge * cells, cells - 1);
        code |= spread(std::uint64_t(cell)) << axis;
      }
    }
    keys[i] = {code, std::uint32_t(i)};
  }
  std::sort(keys.begin(), keys.end(), [](const MortonKey& a, const MortonKey& b) {
    return a.code != b.code ? a.code < b.code : a.point < b.point;
  });
  std::vector<std::uint32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = keys[i].point;
  return order;
}

void sort_in_morton_order(Splats& splats) {
  const std::vector<std::uint32_t> order =
      morton_order(count(splats), [&](std::size_t i) { return center(splats, i); });
  if (auto* windows = std::get_if<TriangleWindows>(&splats.kernel)) {
    reorder(windows->corners, 3, order);
    reorder(windows->sigma, 1, order);
    reorder(windows->opacity, 1, order);
  } else if (auto* gaussians = std::get_if<Gaussians>(&splats.kernel)) {
    reorder(gaussians->centers, 1, order);
    reorder(gaussians->scales, 1, order);
    reorder(gaussians->rotations, 1, order);
    reorder(gaussians->opacity, 1, order);
  } else {
    auto& densities = std::get<NeuralDensities>(splats.kernel);
    reorder(densities.centers, 1, order);
    reorder(densities.semi_axes, 1, order);
    reorder(densities.rotations, 1, order);
    reorder(densities.networks, NeuralDensities::parameters, order);
  }
  reorder(splats.color.coefficients, coefficients_per_splat(splats.color), order);
}

std::size_t morton_order_bytes(const Splats& splats) {
  std::size_t largest = std::max(sizeof(glm::quat), 3 * sizeof(glm::vec3));
  if (std::holds_alternative<NeuralDensities>(splats.kernel))
    largest = NeuralDensities::parameters * sizeof(float);
  largest = std::max(largest, coefficients_per_splat(splats.color) * sizeof(glm::vec3));
  return count(splats) * (sizeof(MortonKey) + sizeof(std::uint32_t) + largest);
}

}  // namespace tureen
