#include "scene/edit/lattice_refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "image/quantise.hpp"
#include "scene/lattice.hpp"

namespace tureen {
namespace lattice_refine_test {

double sampled(int level, const std::vector<float>& texels, double b0, double b1) {
  const auto at = lattice::footprint(level, b0, b1);
  double value = 0;
  for (int k = 0; k < 3; ++k) value += at.weights[k] * double(texels[at.texels[k] * 2]);
  return value;
}

TEST(LatticeRefine, TheFunctionOnTheFaceStaysTheSame) {
  const unsigned seed = 20251;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int from = 0; from <= lattice::max_level; ++from)
    for (int to = from; to <= lattice::max_level; ++to) {
      std::vector<float> coarse(2 * lattice::texel_count(from)), fine(2 * lattice::texel_count(to));
      for (float& value : coarse) value = unit(random);
      refine_lattice(from, to, 2, coarse, fine);
      for (int i = 0; i < 200; ++i) {
        double b0 = double(unit(random)), b1 = double(unit(random));
        if (b0 + b1 > 1) b0 = 1 - b0, b1 = 1 - b1;
        // Texels are floats: one rounding of each value below 1.
        ASSERT_NEAR(sampled(from, coarse, b0, b1), sampled(to, fine, b0, b1), 6e-8)
            << from << " to " << to << " at " << b0 << ", " << b1;
      }
    }
}

TEST(LatticeRefine, TheHighestLevelOfAllFaces) {
  LatticeTexture texture;
  EXPECT_EQ(highest_level(texture), 0);
  texture.patches = {{0, 2}, {6, 5}, {0, 1}};
  EXPECT_EQ(highest_level(texture), 5);
}

TEST(Quantise, EveryByteIsItsOwnValueAndHalvesRoundUp) {
  for (int byte = 0; byte < 256; ++byte) {
    EXPECT_EQ(quantised_unit(float(byte) / 255.0f), byte);
    EXPECT_EQ(quantised_alpha(float(byte) / 255.0f), byte);
  }
  EXPECT_EQ(quantised_unit(-1.0f), 0);
  EXPECT_EQ(quantised_unit(2.0f), 255);
  EXPECT_EQ(quantised_unit(INFINITY), 255);
  EXPECT_EQ(quantised_unit(NAN), 0);
}

// docs/numerics.md, T3: no texel crosses 1/2, the threshold of visibility.
TEST(Quantise, AlphaKeepsItsSideOfOneHalf) {
  const auto drawn = [](std::uint8_t byte) { return float(byte) / 255.0f >= 0.5f; };
  EXPECT_EQ(quantised_alpha(0.5f), 128);
  EXPECT_EQ(quantised_alpha(std::nextafter(0.5f, 0.0f)), 127);
  for (int i = 0; i <= 1000000; ++i) {
    const float alpha = float(i) * 1e-6f;
    const std::uint8_t byte = quantised_alpha(alpha);
    ASSERT_EQ(drawn(byte), alpha >= 0.5f) << alpha;
    // Half a step, and the rounding of this comparison.
    ASSERT_LE(std::abs(double(byte) / 255 - double(alpha)), 0.5 / 255 + 1e-12) << alpha;
  }
}

}  // namespace lattice_refine_test
}  // namespace tureen
