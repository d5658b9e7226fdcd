// Texels of compressed files: exact if lossless, else within their step. Any bytes give texels or
// an InputError.
#include "formats/tureen_glb/compressed_texels.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scene/lattice.hpp"
#include "tests/formats/random_scene.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace compressed_texels_test {

using test::RandomScene;

constexpr int channels = LatticeTexture::channels;
constexpr int alpha = LatticeTexture::features;

LatticeTexture decoded(const LatticeTexture& texture, const CompressedTexelOptions& options) {
  return decode_compressed_texels(encode_compressed_texels(texture, options),
                                  texture.patches.size(), "compressed");
}

int byte_of(const LatticeTexture& texture, std::size_t face, std::uint32_t i, int c) {
  const std::size_t at = (texture.patches[face].first_texel + i) * std::size_t(channels);
  return std::get<std::vector<std::uint8_t>>(texture.texels)[at + std::size_t(c)];
}

/// Calls visit(face, texel of the face, channel, byte before, byte after).
template <class Visit>
void for_each_value(const LatticeTexture& before, const LatticeTexture& after, Visit&& visit) {
  ASSERT_EQ(before.patches.size(), after.patches.size());
  for (std::size_t t = 0; t < before.patches.size(); ++t) {
    ASSERT_EQ(before.patches[t].level, after.patches[t].level) << "face " << t;
    for (std::uint32_t i = 0; i < lattice::texel_count(int(before.patches[t].level)); ++i)
      for (int c = 0; c < channels; ++c)
        visit(t, i, c, byte_of(before, t, i, c), byte_of(after, t, i, c));
  }
}

/// Smooth texels: every value is affine over the face.
LatticeTexture smooth(std::size_t faces, int level, std::mt19937& random) {
  LatticeTexture texture;
  std::vector<std::uint8_t> texels;
  for (std::size_t t = 0; t < faces; ++t) {
    texture.patches.push_back(
        {std::uint32_t(t * lattice::texel_count(level)), std::uint32_t(level)});
    const int n = lattice::resolution(level);
    int corner[3][channels];
    for (auto& values : corner)
      for (int& value : values) value = 128 + int(random() % 127);
    for (std::uint32_t i = 0; i < lattice::texel_count(level); ++i) {
      const auto at = lattice::texel_coordinates(i);
      for (int c = 0; c < channels; ++c)
        texels.push_back(std::uint8_t(
            (corner[0][c] * at.x + corner[1][c] * at.y + corner[2][c] * (n - at.x - at.y)) / n));
    }
  }
  texture.texels = std::move(texels);
  return texture;
}

class CompressedTexels : public ::testing::TestWithParam<int> {};

TEST_P(CompressedTexels, LoseNothingAtStepsOfOne) {
  const unsigned seed = 31 + unsigned(GetParam());
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  RandomScene random(seed);
  const std::optional<int> level =
      GetParam() > lattice::max_level ? std::nullopt : std::optional<int>(GetParam());
  const LatticeTexture texture =
      random.lattice_texture(level.value_or(0) > 5 ? 2 : 11, level, false);
  for_each_value(texture, decoded(texture, {.keep_hidden = true}),
                 [](std::size_t t, std::uint32_t i, int c, int before, int after) {
                   ASSERT_EQ(before, after) << "face " << t << ", texel " << i << ", channel " << c;
                 });
}

TEST_P(CompressedTexels, AreOffByHalfAStepAtMost) {
  const unsigned seed = 41 + unsigned(GetParam());
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  RandomScene random(seed);
  const std::optional<int> level =
      GetParam() > lattice::max_level ? std::nullopt : std::optional<int>(GetParam());
  const LatticeTexture texture =
      random.lattice_texture(level.value_or(0) > 5 ? 2 : 11, level, false);
  CompressedTexelOptions options{.feature_step = 12, .alpha_step = 40, .keep_hidden = true};
  // Each face has its own coarseness; faces with shared texels use the smallest one.
  std::vector<int> step(texture.patches.size());
  for (std::size_t t = 0; t < texture.patches.size(); ++t)
    options.coarseness.push_back(std::uint8_t(random.whole(8)));
  for (std::size_t t = 0; t < texture.patches.size(); ++t) {
    int least = 7;
    for (std::size_t u = 0; u < texture.patches.size(); ++u)
      if (texture.patches[u].first_texel == texture.patches[t].first_texel)
        least = std::min<int>(least, options.coarseness[u]);
    step[t] = 12 * compress_multipliers[std::size_t(least)] / 4;
  }
  const LatticeTexture back = decoded(texture, options);
  for_each_value(texture, back, [&](std::size_t t, std::uint32_t i, int c, int before, int after) {
    ASSERT_LE(2 * std::abs(before - after), c == alpha ? 2 * 40 : step[t])
        << "face " << t << ", texel " << i << ", channel " << c;
    // Alpha never crosses 1/2.
    if (c == alpha) {
      ASSERT_EQ(before >= 128, after >= 128) << "face " << t << ", " << i;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(LevelOrMixed, CompressedTexels,
                         ::testing::Range(0, lattice::max_level + 2));

TEST(CompressedTexelsOf, FloatsAreThoseOfTheirBytes) {
  RandomScene random(51);
  const LatticeTexture floats = random.lattice_texture(7, 2, true);
  const LatticeTexture back = decoded(floats, {.keep_hidden = true});
  for (std::size_t t = 0; t < floats.patches.size(); ++t)
    for (std::uint32_t i = 0; i < lattice::texel_count(2); ++i)
      for (int c = 0; c < channels; ++c)
        // Half a byte; alpha near 1/2 may be off by a whole one, to stay on its side.
        ASSERT_NEAR(back.value(back.patches[t].first_texel + i, c),
                    floats.value(floats.patches[t].first_texel + i, c),
                    (c == alpha ? 1.01 : 0.51) / 255.0);
}

TEST(CompressedTexelsOf, WhatNobodySeesIsNotKept) {
  const unsigned seed = 52;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  RandomScene random(seed);
  LatticeTexture texture = random.lattice_texture(40, 3, false);
  auto& texels = std::get<std::vector<std::uint8_t>>(texture.texels);
  // Half of the faces are entirely transparent or opaque, the others are cut at random.
  for (std::size_t t = 0; t < 20; ++t)
    for (std::size_t i = 0; i < 45; ++i) {
      std::uint8_t& a = texels[(t * 45 + i) * channels + alpha];
      a = std::uint8_t(t % 2 ? 128 + a / 2 : a / 2);
    }
  const auto all = encode_compressed_texels(texture, {.keep_hidden = true});
  const auto seen = encode_compressed_texels(texture, {});
  // Ten of forty faces have no features, and twenty have almost no alpha.
  EXPECT_LT(double(seen.size()), 0.8 * double(all.size()));
  const LatticeTexture back = decode_compressed_texels(seen, 40, "compressed");
  for_each_value(texture, back, [&](std::size_t t, std::uint32_t i, int c, int before, int after) {
    if (c == alpha) {
      ASSERT_EQ(before >= 128, after >= 128) << "face " << t << ", texel " << i;
      if (t >= 20) return;
    } else if (t % 2 == 1 && t < 20) {
      ASSERT_EQ(before, after) << "face " << t << ", texel " << i << ", channel " << c;
    }
  });
}

TEST(CompressedTexelsOf, SmoothOrEqualFacesTakeLittle) {
  const unsigned seed = 53;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  LatticeTexture texture = smooth(300, 4, random);
  const CompressedTexelOptions options{.feature_step = 8, .alpha_step = 85};
  const std::size_t own = encode_compressed_texels(texture, options).size();
  // Texels are 1224 bytes a face. The corners alone, 21 random features of 4 bits after the step,
  // take 10.5 bytes. The texels between them are sometimes predicted wrongly, because corners are
  // off by half a step.
  EXPECT_LT(own, 300u * 1224u / 30u);
  for (std::size_t t = 10; t < 300; ++t) texture.patches[t] = texture.patches[t % 10];
  const auto shared = encode_compressed_texels(texture, options);
  // Ten faces and 290 references to them take less than one uncompressed face.
  EXPECT_LT(shared.size(), 1224u);
  const LatticeTexture back = decode_compressed_texels(shared, 300, "compressed");
  EXPECT_EQ(back.texel_count(), 10u * 153u);
  for (std::size_t t = 0; t < 300; ++t)
    EXPECT_EQ(back.patches[t].first_texel, back.patches[t % 10].first_texel);
}

/// Mean squared error of the features of each face, in squared byte steps.
std::vector<double> errors_of(const LatticeTexture& texture, const LatticeTexture& back) {
  std::vector<double> result(texture.patches.size(), 0.0);
  for_each_value(texture, back, [&](std::size_t t, std::uint32_t, int c, int before, int after) {
    if (c != alpha) result[t] += double(before - after) * (before - after);
  });
  for (std::size_t t = 0; t < result.size(); ++t)
    result[t] /= lattice::texel_count(int(texture.patches[t].level)) * double(alpha);
  return result;
}

/// Smooth texels with a little noise: most details of a finer level are smaller than a step.
LatticeTexture noisy(std::size_t faces, std::mt19937& random) {
  LatticeTexture texture = smooth(faces, 3, random);
  auto& texels = std::get<std::vector<std::uint8_t>>(texture.texels);
  for (std::size_t i = 0; i < texels.size(); ++i)
    if (i % channels != alpha)
      texels[i] = std::uint8_t(std::min(255, texels[i] - 6 + int(random() % 13)));
  return texture;
}

TEST(CompressedTexelsOf, WhatBitsArePricedSavesThemForTheLeastError) {
  const unsigned seed = 56;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const LatticeTexture texture = noisy(200, random);
  const auto size_and_error = [&](std::uint8_t step, double price) {
    const auto bytes = encode_compressed_texels(
        texture, {.feature_step = step, .alpha_step = 85, .bit_price = price});
    double sum = 0;
    for (const double error :
         errors_of(texture, decode_compressed_texels(bytes, 200, "compressed")))
      sum += error;
    return std::pair(bytes.size(), sum / 200);
  };
  const auto nearest = size_and_error(8, 0), priced = size_and_error(8, 0.3);
  EXPECT_LT(double(priced.first), 0.8 * double(nearest.first));
  EXPECT_GT(priced.second, nearest.second);
  // Larger steps also save bytes, but at the same size their error is larger.
  const auto coarse = size_and_error(12, 0), fine = size_and_error(6, 0.3);
  EXPECT_LT(fine.first, coarse.first);
  EXPECT_LT(fine.second, coarse.second);
}

TEST(CompressedTexelsOf, HeavyTexelsLoseLess) {
  const unsigned seed = 57;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const LatticeTexture texture = noisy(100, random);
  CompressedTexelOptions options{.feature_step = 4, .alpha_step = 85, .bit_price = 0.3};
  const auto alike = encode_compressed_texels(texture, options);
  // Every other face has a small weight.
  for (std::size_t t = 0; t < 100; ++t)
    options.weights.insert(options.weights.end(), 45, t % 2 ? 1.0f : 0.01f);
  const auto some = encode_compressed_texels(texture, options);
  EXPECT_LT(double(some.size()), 0.75 * double(alike.size()));
  const auto errors = errors_of(texture, decode_compressed_texels(some, 100, "compressed"));
  double light = 0, heavy = 0;
  for (std::size_t t = 0; t < 100; ++t) (t % 2 ? heavy : light) += errors[t];
  EXPECT_GT(light, 2 * heavy);

  // Equal patches are stored once, with the larger weight of each texel.
  LatticeTexture twice = texture;
  auto& texels = std::get<std::vector<std::uint8_t>>(twice.texels);
  texels.insert(texels.end(), texels.begin(), texels.end());
  for (std::size_t t = 0; t < 100; ++t)
    twice.patches.push_back({texture.patches[t].first_texel + 4500, 3});
  CompressedTexelOptions mixed = options, heaviest = options;
  heaviest.weights.assign(9000, 1.0f);
  mixed.weights.clear();
  for (std::size_t i = 0; i < 9000; ++i) mixed.weights.push_back(i % 2 == i / 4500 ? 1.0f : 0.01f);
  EXPECT_EQ(encode_compressed_texels(twice, mixed), encode_compressed_texels(twice, heaviest));
}

TEST(CompressedTexelsOf, NothingIsAnEmptyTexture) {
  LatticeTexture texture;
  texture.texels = std::vector<std::uint8_t>();
  EXPECT_EQ(decoded(texture, {}).texel_count(), 0u);
}

TEST(CompressedTexelBytes, SurviveDamage) {
  RandomScene random(54);
  const LatticeTexture texture = random.lattice_texture(3, 1, false);
  const auto bytes = encode_compressed_texels(texture, {.feature_step = 16, .alpha_step = 85});
  const auto read = [&](std::span<const std::byte> b) {
    const LatticeTexture back = decode_compressed_texels(b, 3, "compressed");
    ASSERT_EQ(back.patches.size(), 3u);
    for (const LatticePatch& patch : back.patches)
      ASSERT_LE(patch.first_texel + lattice::texel_count(int(patch.level)), back.texel_count());
  };
  const auto cut = test::survive_truncation(bytes, read);
  EXPECT_EQ(cut.read, 0u);
  EXPECT_EQ(cut.refused, bytes.size());
  // Most damage gives other valid texels, which the decoder cannot detect.
  const auto damaged = test::survive_damage(bytes, read);
  EXPECT_GT(damaged.read, 0u);
}

TEST(CompressedTexelBytes, SurviveAnything) {
  const unsigned seed = 55;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const auto read = [](std::span<const std::byte> b) {
    decode_compressed_texels(b, 50, "compressed");
  };
  test::Survival survival;
  for (int run = 0; run < 100; ++run) {
    std::vector<std::byte> bytes(random() % 1000);
    for (std::byte& b : bytes) b = std::byte(random());
    test::expect_survival(bytes, read, "random bytes " + std::to_string(run), survival);
  }
  EXPECT_GT(survival.refused, 0u);
}

TEST(CompressedTexelBytes, FewCannotAskForMuch) {
  const std::vector<std::byte> bytes(300, std::byte{1});
  EXPECT_THROW(decode_compressed_texels(bytes, std::size_t(1) << 32, "compressed"), InputError);
  EXPECT_THROW(decode_compressed_texels(bytes, 300 * 64 + 1, "compressed"), InputError);
}

}  // namespace compressed_texels_test
}  // namespace tureen
