// Colour without the network, and texels with fewer bits: held against their definitions.
#include "soup/baked_color.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "soup/lattice.hpp"
#include "soup/preset_data.hpp"
#include "soup/quantise.hpp"
#include "soup/spherical_harmonics.hpp"

namespace tureen {
namespace {

constexpr unsigned seed = 20262;

ColorMlp random_mlp(std::mt19937& random, int inputs, DirectionEncoding encoding,
                    std::optional<int> blend) {
  std::normal_distribution<float> normal;
  ColorMlp mlp;
  for (const auto& [in, out] : {std::pair{inputs, 16}, {16, 16}, {16, 3}}) {
    DenseLayer layer{in, out, {}, {}};
    for (int i = 0; i < in * out; ++i) layer.weights.push_back(0.4f * normal(random));
    for (int i = 0; i < out; ++i) layer.biases.push_back(0.1f * normal(random));
    mlp.layers.push_back(std::move(layer));
  }
  mlp.encoding = encoding;
  mlp.blend_channel = blend;
  return mlp;
}

/// One face of level 2, all of it visible.
LatticeTexture random_texture(std::mt19937& random, bool floats, ColorMlp mlp) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  LatticeTexture texture;
  texture.patches = {{0, 2}};
  std::vector<float> values;
  for (std::uint32_t i = 0; i < lattice::texel_count(2) * LatticeTexture::channels; ++i)
    values.push_back(i % LatticeTexture::channels == 7 ? 1.0f : unit(random));
  if (floats) {
    texture.texels = values;
  } else {
    std::vector<std::uint8_t> bytes;
    for (const float value : values) bytes.push_back(quantised_unit(value));
    texture.texels = bytes;
  }
  texture.mlp = std::move(mlp);
  return texture;
}

glm::dvec3 network_color(const LatticeTexture& texture, std::size_t texel, glm::dvec3 to_eye) {
  double features[LatticeTexture::features];
  for (int c = 0; c < LatticeTexture::features; ++c) features[c] = texture.value(texel, c);
  return evaluate(*texture.mlp, features, to_eye);
}

/// Not clamped.
glm::dvec3 baked_color_at(const LatticeTexture& texture, std::size_t texel, glm::dvec3 to_eye) {
  glm::dvec3 color(texture.value(texel, 0), texture.value(texel, 1), texture.value(texel, 2));
  if (!texture.harmonics) return color;
  const auto basis = harmonics::basis(to_eye);
  const auto values = std::size_t(texture.harmonics->values_per_texel());
  for (std::size_t i = 0; i < values; ++i)
    color[int(i % 3)] += basis[1 + i / 3] * texture.harmonics->value(texel * values + i);
  return color;
}

TEST(BakedColor, DirectionsAreUniform) {
  const auto directions = bake_directions();
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = 0;
      for (const glm::vec3& d : directions) {
        const auto basis = harmonics::basis(glm::dvec3(d));
        sum += basis[i] * basis[j];
      }
      // The mean over the sphere of a product is 1 / 4 pi where they are the same, else 0.
      EXPECT_NEAR(sum / double(directions.size()) * 4 * M_PI, i == j ? 1 : 0, 0.05)
          << i << " " << j;
    }
}

// Least squares: what is left is orthogonal to every basis function over the fit's directions.
TEST(BakedColor, IsTheLeastSquaresFit) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const LatticeTexture texture =
      random_texture(random, true, random_mlp(random, 16, DirectionEncoding::harmonics2, 3));
  for (int degree = 0; degree <= 2; ++degree) {
    const LatticeTexture baked = baked_color(texture, {.degree = degree});
    EXPECT_FALSE(baked.mlp);
    EXPECT_EQ(baked.harmonics.has_value(), degree > 0);
    for (std::size_t texel = 0; texel < texture.texel_count(); ++texel)
      for (int i = 0; i < harmonics::count(degree); ++i) {
        glm::dvec3 product(0.0);
        for (const glm::vec3& d : bake_directions())
          product += harmonics::basis(glm::dvec3(d))[i] *
                     (network_color(texture, texel, d) - baked_color_at(baked, texel, d));
        // The network and the fit run in float: 32 terms of a few 1e-7.
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(product[c], 0, 2e-5) << degree << " " << i;
      }
  }
}

TEST(BakedColor, MoreBandsAreNearer) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  double error[4] = {};
  for (int network = 0; network < 8; ++network) {
    const LatticeTexture texture = random_texture(
        random, network % 2 == 0, random_mlp(random, 16, DirectionEncoding::harmonics2, 3));
    const LatticeTexture candidates[] = {base_color(texture), baked_color(texture, {.degree = 0}),
                                         baked_color(texture, {.degree = 1}),
                                         baked_color(texture, {.degree = 2})};
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 d =
          glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
      for (std::size_t texel = 0; texel < texture.texel_count(); ++texel)
        for (int k = 0; k < 4; ++k) {
          const glm::dvec3 e =
              baked_color_at(candidates[k], texel, d) - network_color(texture, texel, d);
          error[k] += glm::dot(e, e);
        }
    }
  }
  EXPECT_LT(error[1], 0.5 * error[0]);
  EXPECT_LT(error[2], 0.9 * error[1]);
  EXPECT_LT(error[3], 0.7 * error[2]);
  for (int k = 0; k < 4; ++k)
    RecordProperty("psnr_" + std::to_string(k),
                   std::to_string(-10 * std::log10(error[k] / (8.0 * 200 * 15 * 3))));
}

TEST(BakedColor, WithoutADirectionDegreeZeroIsExact) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (const bool floats : {false, true}) {
    const LatticeTexture texture =
        random_texture(random, floats, random_mlp(random, 7, DirectionEncoding::none, 3));
    const LatticeTexture baked = baked_color(texture, {.degree = 0});
    const LatticeTexture second = baked_color(texture, {.degree = 2});
    for (std::size_t texel = 0; texel < texture.texel_count(); ++texel) {
      const glm::dvec3 truth = network_color(texture, texel, {0, 0, 1});
      for (int c = 0; c < 3; ++c) {
        // Half a step of 8 bits; without them the fit's float arithmetic.
        const double tolerance = floats ? 3e-6 : 0.5 / 255 + 3e-6;
        EXPECT_NEAR(baked_color_at(baked, texel, {0, 0, 1})[c], truth[c], tolerance);
        EXPECT_NEAR(baked_color_at(second, texel, {0.6, 0, 0.8})[c], truth[c], 1.1 * tolerance);
      }
      EXPECT_EQ(baked.value(texel, 3), 0.0f);
      EXPECT_EQ(baked.value(texel, 7), texture.value(texel, 7));
    }
  }
}

// The convention of the direction is the network's until it is baked, and ours after.
TEST(BakedColor, TheDirectionIsTurned) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  ColorMlp mlp = random_mlp(random, 10, DirectionEncoding::xyz, {});
  mlp.view = ViewConvention::eye_to_surface;
  const LatticeTexture texture = random_texture(random, true, mlp);
  const LatticeTexture baked = baked_color(texture, {.degree = 2});
  double same = 0, turned = 0;
  for (const glm::vec3& direction : bake_directions())
    for (std::size_t texel = 0; texel < texture.texel_count(); ++texel) {
      const glm::dvec3 truth = network_color(texture, texel, direction);
      const glm::dvec3 d(direction);
      same += glm::dot(baked_color_at(baked, texel, d) - truth,
                       baked_color_at(baked, texel, d) - truth);
      turned += glm::dot(baked_color_at(baked, texel, -d) - truth,
                         baked_color_at(baked, texel, -d) - truth);
    }
  EXPECT_LT(same, 0.1 * turned);
}

TEST(BakedColor, TexelsThatNobodySeesKeepTheirBase) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  LatticeTexture texture =
      random_texture(random, false, random_mlp(random, 16, DirectionEncoding::harmonics2, 3));
  auto& bytes = std::get<std::vector<std::uint8_t>>(texture.texels);
  // Only the corner of vertex 2 is opaque: its cell has texels 0, 1 and 2.
  for (std::size_t texel = 1; texel < texture.texel_count(); ++texel)
    bytes[texel * LatticeTexture::channels + 7] = 0;
  const LatticeTexture baked = baked_color(texture, {.degree = 1});
  for (std::size_t texel = 0; texel < texture.texel_count(); ++texel) {
    bool banded = false;
    for (std::size_t i = 0; i < 9; ++i) banded |= baked.harmonics->value(9 * texel + i) != 0;
    EXPECT_EQ(banded, texel < 3) << texel;
    for (int c = 0; c < 3 && texel >= 3; ++c)
      EXPECT_EQ(baked.value(texel, c), texture.value(texel, c));
  }
}

// -- bits -----------------------------------------------------------------------------------------

TEST(TexelBits, AreRoundedToTheNearestAndAlphaKeepsItsSide) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  LatticeTexture texture;
  texture.patches = {{0, 7}};
  std::vector<float> values(lattice::texel_count(7) * LatticeTexture::channels);
  for (float& value : values) value = unit(random);
  for (std::size_t i = 7; i < 4000; i += 8)  // close to the threshold, on both sides
    values[i] = 0.5f + (unit(random) - 0.5f) * 1e-3f;
  values[7] = 0.5f, values[15] = std::nextafter(0.5f, 0.0f);
  texture.texels = values;
  for (const int bits : {16, 8, 4}) {
    SCOPED_TRACE(bits);
    LatticeTexture reduced = texture;
    reduce_texel_bits(reduced, bits);
    // Half of the largest step below 1: 2^-11 of halves, 1/255, 1/15.
    const double half_step = bits == 16 ? std::ldexp(1.0, -12) : 0.5 / ((1 << bits) - 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float value = reduced.value(i / 8, int(i % 8));
      // An alpha may have to go to the other neighbour.
      const double tolerance = i % 8 == 7 ? 2 * half_step : half_step;
      ASSERT_NEAR(value, values[i], tolerance + 1e-7) << i;
      if (i % 8 == 7) {
        ASSERT_EQ(value >= 0.5f, values[i] >= 0.5f) << values[i];
      }
      if (bits == 4) {
        ASSERT_NEAR(value * 15, std::round(value * 15), 1e-5);
      }
    }
    LatticeTexture again = reduced;
    reduce_texel_bits(again, bits);
    EXPECT_TRUE(again.texels == reduced.texels);
  }
}

}  // namespace
}  // namespace tureen
