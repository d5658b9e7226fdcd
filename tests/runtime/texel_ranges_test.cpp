// Ranges of texels, compared with the place of one extreme value.
#include "runtime/plan/texel_ranges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tureen {
namespace texel_ranges_test {

constexpr int channels = LatticeTexture::channels;

/// Texels of levels 0 to 3: odd numbers and even ones.
constexpr std::size_t counts[] = {3, 6, 15, 45};

template <class Value>
class TexelRangesOf : public testing::Test {};
using Values = testing::Types<std::uint8_t, float>;
TYPED_TEST_SUITE(TexelRangesOf, Values);

TYPED_TEST(TexelRangesOf, HaveEveryValue) {
  for (const std::size_t count : counts)
    for (std::size_t place = 0; place < count * channels; ++place) {
      std::vector<TypeParam> texels(count * channels, TypeParam(100));
      texels[place] = TypeParam(7);
      TexelRanges<TypeParam> ranges;
      ranges.add(texels.data(), count);
      texels[place] = TypeParam(203);
      ranges.add(texels.data(), count);
      for (int c = 0; c < channels; ++c) {
        const bool here = std::size_t(c) == place % channels;
        EXPECT_EQ(ranges.low(c), here ? 7 : 100) << place << " of " << count;
        EXPECT_EQ(ranges.high(c), here ? 203 : 100) << place << " of " << count;
      }
    }
}

TEST(TexelRanges, IgnoreNan) {
  for (std::size_t place = 0; place < 3 * channels; ++place) {
    std::vector<float> texels(3 * channels, 0.25f);
    texels[place] = std::nanf("");
    TexelRanges<float> ranges;
    ranges.add(texels.data(), 3);
    for (int c = 0; c < channels; ++c) {
      EXPECT_EQ(ranges.low(c), 0.25f);
      EXPECT_EQ(ranges.high(c), 0.25f);
    }
  }
}

}  // namespace texel_ranges_test
}  // namespace tureen
