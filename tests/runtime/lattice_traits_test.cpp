// The measurement of lattice textures, compared with plain loops.
#include "runtime/plan/lattice_traits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "scene/lattice.hpp"

namespace tureen {
namespace lattice_traits_test {

constexpr int alpha = LatticeTexture::features;

/// Faces of levels 0 to 4: constant, affine with rounded texels, or random; the last shares the
/// texels of the first.
template <class Value>
LatticeTexture mixed(std::uint32_t seed, bool shares) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> real(0, 1);
  const auto stored = [](float v) { return Value(sizeof(Value) == 1 ? std::lround(255 * v) : v); };
  LatticeTexture texture;
  std::vector<Value> values;
  for (std::uint32_t face = 0; face < 30; ++face) {
    const int level = int(face % 5), n = lattice::resolution(level);
    texture.patches.push_back(
        {std::uint32_t(values.size() / LatticeTexture::channels), std::uint32_t(level)});
    float corners[LatticeTexture::channels][3];
    for (auto& channel : corners)
      for (float& corner : channel) corner = real(random);
    for (std::uint32_t k = 0; k < lattice::texel_count(level); ++k) {
      const auto [x, y] = lattice::texel_coordinates(k);
      for (int c = 0; c < LatticeTexture::channels; ++c) {
        const float b0 = float(x) / float(n), b1 = float(y) / float(n);
        const float affine =
            b0 * corners[c][0] + b1 * corners[c][1] + (1 - b0 - b1) * corners[c][2];
        const float value = face % 3 == 0 ? corners[c][0] : face % 3 == 1 ? affine : real(random);
        values.push_back(stored(c == alpha && face % 2 == 0 ? 0.5f + 0.5f * value : value));
      }
    }
  }
  if (shares) texture.patches.push_back(texture.patches.front());
  texture.texels = std::move(values);
  return texture;
}

std::vector<std::uint32_t> all_faces(const LatticeTexture& texture) {
  std::vector<std::uint32_t> faces(texture.patches.size());
  std::iota(faces.begin(), faces.end(), 0u);
  return faces;
}

/// Calls visit(value) for each texel of the face.
template <class Visit>
void for_each_texel(const LatticeTexture& texture, std::uint32_t face, const Visit& visit) {
  const LatticePatch& patch = texture.patches[face];
  for (std::uint32_t k = 0; k < lattice::texel_count(int(patch.level)); ++k)
    visit(std::size_t(patch.first_texel) + k, lattice::texel_coordinates(k));
}

void expect_measured(const LatticeTexture& texture) {
  const LatticeTraits traits = measure(texture, all_faces(texture));
  std::size_t constant = 0;
  for (int c = 0; c < alpha; ++c) {
    float low = INFINITY, high = -INFINITY;
    for (const std::uint32_t face : all_faces(texture))
      for_each_texel(texture, face, [&](std::size_t texel, lattice::Coordinates) {
        low = std::fmin(low, texture.value(texel, c));
        high = std::fmax(high, texture.value(texel, c));
      });
    EXPECT_FLOAT_EQ(traits.ranges[std::size_t(c)].low, low) << c;
    EXPECT_FLOAT_EQ(traits.ranges[std::size_t(c)].high, high) << c;
  }
  for (const std::uint32_t face : all_faces(texture)) {
    bool same = true;
    for_each_texel(texture, face, [&](std::size_t texel, lattice::Coordinates) {
      for (int c = 0; c < LatticeTexture::channels; ++c)
        same =
            same && texture.value(texel, c) == texture.value(texture.patches[face].first_texel, c);
    });
    constant += same ? 1 : 0;
  }
  EXPECT_EQ(traits.constant_faces, constant);
  EXPECT_EQ(traits.lowest_level, 0);
  EXPECT_EQ(traits.highest_level, 4);
}

TEST(LatticeTraits, AreThoseOfPlainLoops) {
  expect_measured(mixed<std::uint8_t>(1, false));
  expect_measured(mixed<float>(2, true));
}

TEST(LatticeTraits, FindSharedTexels) {
  const LatticeTexture alone = mixed<std::uint8_t>(3, false), shared = mixed<std::uint8_t>(3, true);
  EXPECT_FALSE(measure(alone, all_faces(alone)).shares_texels);
  EXPECT_TRUE(measure(shared, all_faces(shared)).shares_texels);
}

TEST(LatticeTraits, IgnoreNanInRanges) {
  LatticeTexture texture = mixed<float>(4, false);
  auto& values = std::get<std::vector<float>>(texture.texels);
  for (int c = 0; c < LatticeTexture::channels; ++c)
    values[std::size_t(c)] = std::numeric_limits<float>::quiet_NaN();
  const LatticeTraits traits = measure(texture, all_faces(texture));
  for (std::size_t c = 0; c < alpha; ++c) {
    EXPECT_GE(traits.ranges[c].low, 0.0f) << c;
    EXPECT_LE(traits.ranges[c].high, 1.0f) << c;
    EXPECT_LT(traits.ranges[c].low, traits.ranges[c].high) << c;
  }
}

/// The error in double precision, and whether the cut-out stays.
void expect_residuals(const LatticeTexture& texture) {
  for (const std::uint32_t face : all_faces(texture)) {
    const LatticePatch& patch = texture.patches[face];
    const int n = lattice::resolution(int(patch.level));
    double worst = 0, worst_alpha = 0;
    bool opaque = true;
    for_each_texel(texture, face, [&](std::size_t texel, lattice::Coordinates at) {
      for (int c = 0; c < LatticeTexture::channels; ++c) {
        const auto corner = [&](int x, int y) {
          return double(texture.value(patch.first_texel + lattice::texel_index(x, y), c));
        };
        const double b0 = double(at.x) / n, b1 = double(at.y) / n;
        const double affine = b0 * corner(n, 0) + b1 * corner(0, n) + (1 - b0 - b1) * corner(0, 0);
        double& largest = c == alpha ? worst_alpha : worst;
        largest = std::max(largest, std::abs(affine - double(texture.value(texel, c))));
      }
      opaque = opaque && texture.value(texel, alpha) >= alpha_threshold;
    });
    const auto residual = affine_residual(texture, face, INFINITY);
    EXPECT_EQ(residual.has_value(), opaque || worst_alpha <= 1e-6) << face;
    if (!residual) continue;
    EXPECT_NEAR(*residual, worst, 1e-6) << face;  // a few ulps of 1
    if (worst < 1e-3) continue;
    EXPECT_TRUE(affine_residual(texture, face, *residual)) << face;
    EXPECT_FALSE(affine_residual(texture, face, 0.99f * *residual)) << face;
  }
}

TEST(AffineResidual, IsTheLargestErrorOfFeatures) {
  expect_residuals(mixed<std::uint8_t>(5, false));
  expect_residuals(mixed<float>(6, false));
}

}  // namespace lattice_traits_test
}  // namespace tureen
