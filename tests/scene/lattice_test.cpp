#include "scene/lattice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tureen {
namespace lattice_test {

TEST(Lattice, CountsAreTheTriangularNumbers) {
  const std::uint32_t expected[] = {3, 6, 15, 45, 153, 561, 2145, 8385};
  for (int level = 0; level <= lattice::max_level; ++level)
    EXPECT_EQ(lattice::texel_count(level), expected[level]);
}

TEST(Lattice, IndexAndCoordinatesAreInverse) {
  for (std::uint32_t i = 0; i < lattice::texel_count(lattice::max_level); ++i) {
    const auto [x, y] = lattice::texel_coordinates(i);
    ASSERT_GE(x, 0);
    ASSERT_GE(y, 0);
    ASSERT_EQ(lattice::texel_index(x, y), i);
  }
}

// Level 0 is a common source of errors: the texel order is vertex 2, vertex 0, vertex 1.
TEST(Lattice, LevelZeroOrderIsVertexTwoZeroOne) {
  EXPECT_EQ(lattice::texel_index(0, 0), 0u);
  EXPECT_EQ(lattice::texel_index(1, 0), 1u);
  EXPECT_EQ(lattice::texel_index(0, 1), 2u);
}

TEST(Lattice, SamplingAtALatticePointReturnsThatTexel) {
  for (int level = 0; level <= lattice::max_level; ++level) {
    const int n = lattice::resolution(level);
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x + y <= n; ++x) {
        // n is a power of two: the barycentrics are exact.
        const auto at = lattice::footprint(level, float(x) / n, float(y) / n);
        float weight = 0;
        for (int k = 0; k < 3; ++k)
          if (at.texels[k] == lattice::texel_index(x, y)) weight += at.weights[k];
        ASSERT_EQ(weight, 1.0f) << "level " << level << " at " << x << ", " << y;
      }
  }
}

TEST(Lattice, AffineFunctionsAreReproduced) {
  for (int level = 0; level <= lattice::max_level; ++level) {
    const int n = lattice::resolution(level);
    for (double b0 = 0; b0 <= 1; b0 += 0.0625)
      for (double b1 = 0; b0 + b1 <= 1; b1 += 0.0625) {
        const auto at = lattice::footprint(level, b0, b1);
        double value = 0, sum = 0;
        for (int k = 0; k < 3; ++k) {
          const auto [x, y] = lattice::texel_coordinates(at.texels[k]);
          value += at.weights[k] * (2.0 * x / n - 3.0 * y / n + 0.5);
          sum += at.weights[k];
        }
        // A few roundings of numbers of order one.
        ASSERT_NEAR(value, 2.0 * b0 - 3.0 * b1 + 0.5, 1e-14);
        ASSERT_NEAR(sum, 1.0, 1e-15);
      }
  }
}

// docs/numerics.md, T1: lookups on and just outside the edges stay within the lattice.
TEST(Lattice, PointsOutsideStayWithinTheTexels) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float values[] = {-1e30f,       -0.3f, -1e-7f, 0.0f,
                          0.3f,         0.5f,  1.0f,   std::nextafter(1.0f, 2.0f),
                          1.0f + 1e-6f, 1.3f,  1e30f,  nan};
  for (int level = 0; level <= lattice::max_level; ++level)
    for (const float b0 : values)
      for (const float b1 : values)
        for (const std::uint32_t texel : lattice::footprint(level, b0, b1).texels)
          ASSERT_LT(texel, lattice::texel_count(level)) << level << ": " << b0 << ", " << b1;
}

}  // namespace lattice_test
}  // namespace tureen
