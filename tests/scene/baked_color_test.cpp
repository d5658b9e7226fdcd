// Colour without the network, compared with its definition.
#include "scene/edit/baked_color.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "image/quantise.hpp"
#include "scene/lattice.hpp"

namespace tureen {
namespace baked_color_test {

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

/// One face of level 2, entirely visible.
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

glm::dvec3 color_of(const LatticeTexture& texture, std::size_t texel) {
  return {texture.value(texel, 0), texture.value(texel, 1), texture.value(texel, 2)};
}

/// The mean over points that are nearly uniform on the sphere.
glm::dvec3 mean_over_sphere(const LatticeTexture& texture, std::size_t texel) {
  constexpr int count = 2000;
  const double golden_angle = M_PI * (3 - std::sqrt(5.0));
  glm::dvec3 sum(0.0);
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1) / double(count), r = std::sqrt(1 - z * z);
    sum += network_color(texture, texel,
                         {r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z});
  }
  return sum / double(count);
}

TEST(BakedColor, IsTheMeanOverAllDirections) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (const bool floats : {false, true})
    for (const DirectionEncoding encoding :
         {DirectionEncoding::xyz, DirectionEncoding::harmonics2}) {
      const int inputs = encoding == DirectionEncoding::xyz ? 10 : 16;
      const LatticeTexture texture =
          random_texture(random, floats, random_mlp(random, inputs, encoding, 3));
      const LatticeTexture baked = baked_color(texture);
      EXPECT_FALSE(baked.mlp);
      EXPECT_EQ(baked.is_float(), floats);
      double squares = 0;
      for (std::size_t texel = 0; texel < texture.texel_count(); ++texel) {
        const glm::dvec3 off = color_of(baked, texel) - mean_over_sphere(texture, texel);
        squares += dot(off, off);
        EXPECT_EQ(baked.value(texel, 3), 0.0f);
        EXPECT_EQ(baked.value(texel, 7), texture.value(texel, 7));
      }
      // The rule of 26 points is exact only up to degree 7. For 400 such networks, its root mean
      // square error over a texture is at most 1.43e-3, within half a step of 8 bits. Single texels
      // are off by up to 6.1e-3. Texels of bytes add at most another half step.
      const double rms = std::sqrt(squares / (3.0 * double(texture.texel_count())));
      EXPECT_LT(rms, (floats ? 0.5 : 1.0) / 255);
    }
}

TEST(BakedColor, WithoutADirectionItIsExact) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (const bool floats : {false, true}) {
    const LatticeTexture texture =
        random_texture(random, floats, random_mlp(random, 7, DirectionEncoding::none, 3));
    const LatticeTexture baked = baked_color(texture);
    for (std::size_t texel = 0; texel < texture.texel_count(); ++texel) {
      const glm::dvec3 truth = network_color(texture, texel, {0, 0, 1});
      // Half a step of 8 bits. Without bytes, only the error of the network's float arithmetic.
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(color_of(baked, texel)[c], truth[c], (floats ? 0 : 0.5 / 255) + 3e-6);
    }
  }
}

TEST(BakedColor, IsNearerThanTheBase) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  double base_error = 0, baked_error = 0;
  for (int network = 0; network < 8; ++network) {
    const LatticeTexture texture = random_texture(
        random, network % 2 == 0, random_mlp(random, 16, DirectionEncoding::harmonics2, 3));
    const LatticeTexture base = base_color(texture), baked = baked_color(texture);
    EXPECT_FALSE(base.mlp);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 d =
          glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
      for (std::size_t texel = 0; texel < texture.texel_count(); ++texel) {
        const glm::dvec3 truth = network_color(texture, texel, d);
        const glm::dvec3 of_base = color_of(base, texel) - truth;
        const glm::dvec3 of_baked = color_of(baked, texel) - truth;
        base_error += glm::dot(of_base, of_base);
        baked_error += glm::dot(of_baked, of_baked);
      }
    }
  }
  EXPECT_LT(baked_error, 0.5 * base_error);
}

TEST(BakedColor, TexelsThatNobodySeesKeepTheirBase) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  LatticeTexture texture =
      random_texture(random, false, random_mlp(random, 16, DirectionEncoding::harmonics2, 3));
  auto& bytes = std::get<std::vector<std::uint8_t>>(texture.texels);
  // Only the corner of vertex 2 is opaque; its cell has texels 0, 1 and 2.
  for (std::size_t texel = 1; texel < texture.texel_count(); ++texel)
    bytes[texel * LatticeTexture::channels + 7] = 0;
  const LatticeTexture baked = baked_color(texture);
  for (std::size_t texel = 0; texel < texture.texel_count(); ++texel)
    EXPECT_EQ(color_of(baked, texel) == color_of(texture, texel), texel >= 3) << texel;
}

}  // namespace baked_color_test
}  // namespace tureen
