#include "scene/edit/morton_order.hpp"

#include <algorithm>
#include <cassert>
#include <glm/common.hpp>
#include <limits>

#include "scene/finite.hpp"
#include "scene/morton.hpp"

namespace tureen {

namespace {

struct MortonKey {
  std::uint64_t code;
  std::uint32_t splat;
};

std::vector<MortonKey> morton_keys(const Splats& splats) {
  const std::size_t splat_count = count(splats);
  assert(splat_count <= std::numeric_limits<std::uint32_t>::max());
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (std::size_t i = 0; i < splat_count; ++i)
    if (const glm::dvec3 p = center(splats, i); is_finite(p)) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  const glm::dvec3 size = high - low;
  const double edge = std::max({size.x, size.y, size.z});
  const double cells = double(1 << morton_bits);
  std::vector<MortonKey> keys(splat_count);
  for (std::size_t i = 0; i < splat_count; ++i) {
    const glm::dvec3 p = center(splats, i);
    std::uint64_t code = std::numeric_limits<std::uint64_t>::max();
    if (is_finite(p)) {
      code = 0;
      for (int axis = 0; axis < 3 && edge > 0; ++axis) {
        const double cell = std::min((p[axis] - low[axis]) / edge * cells, cells - 1);
        code |= spread_bits(std::uint64_t(cell)) << axis;
      }
    }
    keys[i] = {code, std::uint32_t(i)};
  }
  return keys;
}

/// Moves the `each` values of every splat to its new place.
template <class T>
void reorder(std::vector<T>& values, std::size_t each, const std::vector<MortonKey>& keys) {
  assert(values.size() == each * keys.size());
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const MortonKey& key : keys)
    sorted.insert(sorted.end(), values.begin() + std::ptrdiff_t(each * key.splat),
                  values.begin() + std::ptrdiff_t(each * (key.splat + std::size_t(1))));
  values = std::move(sorted);
}

}  // namespace

void sort_in_morton_order(Splats& splats) {
  std::vector<MortonKey> keys = morton_keys(splats);
  std::sort(keys.begin(), keys.end(), [](const MortonKey& a, const MortonKey& b) {
    return a.code != b.code ? a.code < b.code : a.splat < b.splat;
  });
  for_each_array(splats, [&](auto& values, std::size_t each) { reorder(values, each, keys); });
}

std::size_t morton_order_bytes(const Splats& splats) {
  std::size_t largest = 3 * sizeof(glm::vec3);  // corners: one bound for all kernels without more
  for_each_array(splats, [&](const auto& values, std::size_t each) {
    largest = std::max(largest, each * sizeof values[0]);
  });
  return count(splats) * (sizeof(MortonKey) + largest);
}

}  // namespace tureen
