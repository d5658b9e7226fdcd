#include "trainer/diffsoup/kernels/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scene/edit/lattice_refine.hpp"
#include "tests/trainer/random_model.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/diffsoup/levels.hpp"

namespace tureen::trainer {
namespace texture_test {

using test::random_model;

std::vector<float> random_values(std::uint64_t seed, std::size_t count) {
  test::Random random(seed);
  std::vector<float> values(count);
  for (float& value : values) value = float(random.normal());
  return values;
}

TEST(TextureKernel, ParentsAreWhatTheRefinedLatticeIsTheMeanOf) {
  for (int level = 0; level < lattice::max_level; ++level) {
    const auto coarse = random_values(std::uint64_t(level), lattice::texel_count(level));
    std::vector<float> fine(lattice::texel_count(level + 1));
    refine_lattice(level, level + 1, 1, coarse, fine);
    for (std::uint32_t texel = 0; texel < fine.size(); ++texel) {
      const auto [x, y] = lattice::texel_coordinates(texel);
      const kernels::Parents parents = kernels::parents(x, y);
      ASSERT_LT(parents.a, coarse.size());
      ASSERT_LT(parents.b, coarse.size());
      // Halves are exact; the sum is rounded once.
      ASSERT_EQ(fine[texel], 0.5f * coarse[parents.a] + 0.5f * coarse[parents.b])
          << "level " << level << ", texel " << texel;
    }
  }
}

TEST(TextureKernel, LevelsLieOneAfterTheOther) {
  for (int low = 0; low <= lattice::max_level; ++low)
    for (int high = low; high <= lattice::max_level; ++high)
      EXPECT_EQ(kernels::level_begin(low, high), levels::texel_count(low, high - 1));
}

class PyramidOfLevels : public testing::TestWithParam<std::pair<int, int>> {
 protected:
  int low() const { return GetParam().first; }
  int high() const { return GetParam().second; }
};

TEST_P(PyramidOfLevels, SumsLikeTheLevelsInterpolatedOnTheirOwn) {
  const Model model = random_model(5, {.faces = 1, .min_level = low(), .max_level = high()});
  const Pyramid pyramid(low(), high());
  ASSERT_EQ(pyramid.texels(), model.texels());
  ASSERT_EQ(pyramid.fine_texels(), lattice::texel_count(high()));
  std::vector<float> fine(pyramid.fine_texels() * std::size_t(channels)), scratch(fine.size());
  pyramid.sum(model.logits.data(), fine.data(), scratch.data());
  const double step = 1.0 / lattice::resolution(high());
  for (std::uint32_t texel = 0; texel < pyramid.fine_texels(); ++texel) {
    const auto [x, y] = lattice::texel_coordinates(texel);
    for (int c = 0; c < channels; ++c)
      // Sums stay below 64; each level has two roundings of at most 64 / 2^25.
      ASSERT_NEAR(fine[std::size_t(texel) * channels + std::size_t(c)],
                  test::summed_logit(model, 0, x * step, y * step, c), 16 * 0x1p-19)
          << "texel " << texel << ", channel " << c;
  }
}

TEST_P(PyramidOfLevels, ScattersByTheTransposeOfTheSum) {
  // <sum(x), y> = <x, scatter(y)> for any x and y.
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Pyramid pyramid(low(), high());
    const std::size_t texels = pyramid.texels() * std::size_t(channels);
    const std::size_t fine_texels = pyramid.fine_texels() * std::size_t(channels);
    const std::vector<float> x = random_values(2 * seed, texels);
    std::vector<float> y = random_values(2 * seed + 1, fine_texels);
    const std::vector<float> kept = y;
    // Initialised with NaN: scatter must write every texel.
    std::vector<float> sum(fine_texels), scratch(fine_texels), scattered(texels, NAN);
    pyramid.sum(x.data(), sum.data(), scratch.data());
    pyramid.scatter(y.data(), scattered.data());
    double left = 0, right = 0, size = 0;
    for (std::size_t i = 0; i < fine_texels; ++i) {
      left += double(sum[i]) * double(kept[i]);
      size += std::abs(double(sum[i]) * double(kept[i]));
    }
    for (std::size_t i = 0; i < texels; ++i) right += double(x[i]) * double(scattered[i]);
    EXPECT_NEAR(left, right, 1e-6 * size);
  }
}

TEST_P(PyramidOfLevels, TheStoreHoldsTheTextureOfTheModel) {
  const Model model = random_model(6, {.faces = 3, .min_level = low(), .max_level = high()});
  const Pyramid pyramid(low(), high());
  TextureStore store;
  store.values.resize(model.faces() * pyramid.fine_texels());
  store.alpha.resize(model.faces() * pyramid.fine_texels());
  FaceScratch scratch(pyramid);
  std::vector<float> expected;
  for (std::size_t face = 0; face < model.faces(); ++face)
    refresh_texture(pyramid, model, face, store, scratch);
  for (std::size_t face = 0; face < model.faces(); ++face) {
    fine_texture(model, face, expected);
    const float* values = store.values[face * pyramid.fine_texels()].values;
    // Logits agree to 16 / 2^19 (above), and the sigmoid's slope is at most 1/4. Its exponential
    // has a relative error of 3e-7.
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_NEAR(values[i], expected[i], 4 * 0x1p-19 + 3e-7) << "face " << face << ", " << i;
    for (std::size_t i = 0; i < pyramid.fine_texels(); ++i)
      ASSERT_EQ(store.alpha[face * pyramid.fine_texels() + i],
                values[i * channels + alpha_channel]);
  }
}

INSTANTIATE_TEST_SUITE_P(, PyramidOfLevels,
                         testing::Values(std::pair(0, 0), std::pair(0, 1), std::pair(0, 5),
                                         std::pair(1, 4), std::pair(2, 3), std::pair(2, 5),
                                         std::pair(5, 5), std::pair(0, 7)),
                         [](const auto& tested) {
                           return std::to_string(tested.param.first) + "to" +
                                  std::to_string(tested.param.second);
                         });

}  // namespace texture_test
}  // namespace tureen::trainer
