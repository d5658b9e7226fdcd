// The basis of compressed features: it is restored exactly from integers, and its axes have their
// properties.
#include "formats/tureen_glb/compressed_basis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/lattice.hpp"
#include "tests/formats/random_scene.hpp"

namespace tureen {
namespace compressed_basis_test {

constexpr int features = LatticeTexture::features;
constexpr int channels = LatticeTexture::channels;

/// The sensitivity of a random map from features to three colours, plus 0.2 on the diagonal. So no
/// axis counts less than a tenth of the first.
FeatureMatrix random_sensitivity(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  FeatureMatrix result{};
  for (int row = 0; row < 3; ++row) {
    double slope[features];
    for (double& s : slope) s = uniform(random);
    for (std::size_t i = 0; i < features; ++i)
      for (std::size_t j = 0; j < features; ++j) result[i][j] += slope[i] * slope[j];
  }
  for (std::size_t i = 0; i < features; ++i) result[i][i] += 0.2;
  return result;
}

TEST(CompressedBasis, IdentityLosesNothing) {
  test::RandomScene random(81);
  const LatticeTexture texture = random.lattice_texture(5, 3, false);
  const auto& texels = std::get<std::vector<std::uint8_t>>(texture.texels);
  const CompressedBasis basis = CompressedBasis::identity();
  const auto values = basis.values_of(texels);
  for (std::size_t t = 0; t < texels.size(); t += channels)
    for (int f = 0; f < features; ++f)
      ASSERT_EQ(basis.feature(f, std::span(values).subspan(t, features)),
                texels[t + std::size_t(f)]);
}

TEST(CompressedBasis, ValuesSayTheFeatures) {
  const unsigned seed = 82;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 engine(seed);
  test::RandomScene random(seed);
  const LatticeTexture texture = random.lattice_texture(20, 3, false);
  const auto& texels = std::get<std::vector<std::uint8_t>>(texture.texels);
  const CompressedBasis basis = compressed_basis(texture, random_sensitivity(engine), 2.0);
  const auto values = basis.values_of(texels);
  for (std::size_t t = 0; t < texels.size(); t += channels) {
    for (int f = 0; f < features; ++f)
      // Half a value on each of seven axes, plus half a byte. Each axis moves a feature by less
      // than a third: 2 / 16 of a byte divided by the root of the smallest sensitivity, 0.2.
      ASSERT_NEAR(basis.feature(f, std::span(values).subspan(t, features)),
                  texels[t + std::size_t(f)], 0.5 + 7 * 0.5 * 0.3);
    ASSERT_EQ(values[t + features], texels[t + features]);
  }
}

TEST(CompressedBasis, EveryAxisMovesTheColourAlike) {
  const unsigned seed = 83;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 engine(seed);
  test::RandomScene random(seed);
  const LatticeTexture texture = random.lattice_texture(20, 3, false);
  const FeatureMatrix sensitivity = random_sensitivity(engine);
  const double step = 6;
  const CompressedBasis basis = compressed_basis(texture, sensitivity, step);
  for (std::size_t a = 0; a < features; ++a)
    for (std::size_t b = 0; b < features; ++b) {
      double moved = 0;  // x_a^T S x_b: squared movement if a = b, else 0
      for (std::size_t i = 0; i < features; ++i)
        for (std::size_t j = 0; j < features; ++j)
          moved += basis.rows[i][a] / 65536.0 * sensitivity[i][j] * basis.rows[j][b] / 65536.0;
      // The fixed point rounds by 2^-17, and values are about one.
      EXPECT_NEAR(moved * compress_fraction * compress_fraction, a == b ? step * step : 0.0, 1e-2)
          << a << ", " << b;
    }
}

// The first axis is the direction of the largest residuals, weighted by the texels' weights.
TEST(CompressedBasis, AxesAreThoseOfTheTexelsThatCount) {
  LatticeTexture texture;
  std::vector<std::uint8_t> texels;
  std::vector<float> first, second;
  for (std::uint32_t t = 0; t < 2; ++t) {
    texture.patches.push_back({6 * t, 1});
    for (std::uint32_t i = 0; i < 6; ++i) {
      // Odd texels are between even ones: face 0 differs there in feature 2, face 1 in feature 5.
      const auto at = lattice::texel_coordinates(i);
      const bool between = at.x % 2 || at.y % 2;
      for (std::uint32_t c = 0; c < channels; ++c)
        texels.push_back(between && c == (t == 0 ? 2u : 5u) ? 200 : 128);
      first.push_back(t == 0 ? 1.0f : 0.0f);
      second.push_back(t == 0 ? 0.0f : 1.0f);
    }
  }
  texture.texels = std::move(texels);
  FeatureMatrix plain{};
  for (std::size_t i = 0; i < features; ++i) plain[i][i] = 1;
  const auto strongest = [&](const std::vector<float>& weights) {
    const CompressedBasis basis = compressed_basis(texture, plain, 4, weights);
    std::size_t best = 0;
    for (std::size_t f = 1; f < features; ++f)
      if (std::abs(basis.rows[f][0]) > std::abs(basis.rows[best][0])) best = f;
    return best;
  };
  EXPECT_EQ(strongest(first), 2u);
  EXPECT_EQ(strongest(second), 5u);
  // If all weights are 0, the basis is that of a texture without residuals.
  LatticeTexture nothing;
  nothing.texels = std::vector<std::uint8_t>();
  EXPECT_EQ(compressed_basis(texture, plain, 4, std::vector<float>(12, 0.0f)).rows,
            compressed_basis(nothing, plain, 4).rows);
}

TEST(CompressedBasis, AColourThatNothingMovesStillHasABasis) {
  test::RandomScene random(84);
  const LatticeTexture texture = random.lattice_texture(3, 2, false);
  const auto& texels = std::get<std::vector<std::uint8_t>>(texture.texels);
  const CompressedBasis basis = compressed_basis(texture, FeatureMatrix{}, 4.0);
  const auto values = basis.values_of(texels);
  for (int f = 0; f < features; ++f)
    // As above, with a sensitivity of 1.
    EXPECT_NEAR(basis.feature(f, std::span(values).first(features)), texels[std::size_t(f)],
                0.5 + 7 * 0.5 * 0.25);
}

}  // namespace compressed_basis_test
}  // namespace tureen
