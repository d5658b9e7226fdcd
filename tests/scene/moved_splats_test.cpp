// Splats that are moved or sorted: all values of a splat stay together, for every kernel.
#include "scene/edit/moved_splats.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <vector>

#include "scene/edit/morton_order.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace moved_splats_test {

class SplatsOfEachKernel : public testing::TestWithParam<SplatKind> {};

/// `n` values per splat of splat `i` in `a` and of splat `j` in `b`.
template <class Value>
bool same(const std::vector<Value>& a, std::size_t i, const std::vector<Value>& b, std::size_t j,
          std::size_t n = 1) {
  return std::equal(a.begin() + std::ptrdiff_t(n * i), a.begin() + std::ptrdiff_t(n * (i + 1)),
                    b.begin() + std::ptrdiff_t(n * j));
}

bool same_splat(const Splats& a, std::size_t i, const Splats& b, std::size_t j) {
  if (!same(a.color.coefficients, i, b.color.coefficients, j, coefficients_per_splat(a.color)))
    return false;
  return values_of(a.kernel, i) == values_of(b.kernel, j);
}

TEST_P(SplatsOfEachKernel, HaveMovedCenters) {
  const Splats before = random_splats(GetParam(), 50, 0.1, 1);
  Splats after = before;
  glm::dmat4 place = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3));
  place = glm::scale(place, glm::dvec3(-2, 2, 2));  // mirrored
  place[3] = {3, -4, 5, 1};
  move_splats(after, place);
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_NEAR(
        glm::distance(center(after, i), glm::dvec3(place * glm::dvec4(center(before, i), 1))), 0,
        1e-5)
        << i;
}

/// The code of the paper, bit by bit.
std::uint64_t morton_code(const glm::dvec3& in_cube) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = std::uint64_t(std::clamp(in_cube[axis] * 2097152, 0.0, 2097151.0));
    for (int bit = 0; bit < 21; ++bit) code |= (cell >> bit & 1) << (3 * bit + axis);
  }
  return code;
}

TEST_P(SplatsOfEachKernel, AreSortedWhole) {
  const Splats before = random_splats(GetParam(), 200, 0.1, 2);
  Splats after = before;
  sort_in_morton_order(after);
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (std::size_t i = 0; i < 200; ++i) {
    low = glm::min(low, center(before, i));
    high = glm::max(high, center(before, i));
  }
  const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  // One corner of the smallest cube is that of the box, or the cube has the box's middle.
  const auto is_sorted_in = [&](const glm::dvec3& corner) {
    std::vector<std::size_t> order(200);
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return morton_code((center(before, a) - corner) / side) <
             morton_code((center(before, b) - corner) / side);
    });
    std::size_t places = 0;
    for (std::size_t i = 0; i < 200; ++i) places += same_splat(after, i, before, order[i]);
    return places == 200;
  };
  EXPECT_TRUE(is_sorted_in(low) || is_sorted_in(0.5 * (low + high) - 0.5 * side));
}

TEST_P(SplatsOfEachKernel, HaveTheBytesOfTheirArrays) {
  const Splats splats = random_splats(GetParam(), 50, 0.1, 3);
  std::size_t per_splat = bytes_per_splat(splats.kernel, splats.color.degree);
  if (splats.color.per_corner)
    per_splat += 2 * sizeof(glm::vec3) * coefficients_per_splat(splats.color) / 3;
  EXPECT_EQ(byte_size(splats), 50 * per_splat);
}

INSTANTIATE_TEST_SUITE_P(, SplatsOfEachKernel, testing::ValuesIn(splat_kinds),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace moved_splats_test
}  // namespace tureen::test
