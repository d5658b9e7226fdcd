#include "base/radix_sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace tureen {
namespace radix_sort_test {

TEST(RadixSort, IsAStableSortOfFloats) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> values{0.0f,
                            -0.0f,
                            infinity,
                            -infinity,
                            std::numeric_limits<float>::min(),
                            std::numeric_limits<float>::denorm_min()};
  std::mt19937 engine(1);
  for (int i = 0; i < 5000; ++i) {
    const float value = std::ldexp(1.0f + float(engine() % 8) / 8.0f, int(engine() % 200) - 100);
    values.push_back(engine() % 2 ? value : -value);  // every value several times
  }
  std::vector<KeyedIndex> items, scratch;
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    items.push_back({sort_key(values[i]), i});
    expected.push_back(i);
  }
  radix_sort(items, scratch);
  std::stable_sort(expected.begin(), expected.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return values[a] < values[b]; });
  for (std::size_t i = 0; i < items.size(); ++i) ASSERT_EQ(items[i].index, expected[i]) << i;
}

}  // namespace radix_sort_test
}  // namespace tureen
