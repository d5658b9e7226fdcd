#include "trainer/diffsoup/levels.hpp"

#include <gtest/gtest.h>

#include "scene/edit/lattice_refine.hpp"
#include "tests/trainer/random_model.hpp"

namespace tureen::trainer {
namespace levels_test {

using test::random_model;

TEST(Levels, TheirNumberOfTexels) {
  EXPECT_EQ(levels::texel_count(2, 5), 15u + 45u + 153u + 561u);  // DiffSoup: 774
  EXPECT_EQ(levels::texel_count(0, 0), 3u);
  EXPECT_EQ(levels::texel_count(3, 2), 0u);
}

TEST(Levels, TheSumIsThatOfEachLevelInterpolatedOnItsOwn) {
  for (int min = 0; min <= lattice::max_level; ++min)
    for (int max = min; max <= lattice::max_level; ++max) {
      const Model model = random_model(7, {.faces = 1, .min_level = min, .max_level = max});
      std::vector<float> fine(std::size_t(lattice::texel_count(max)) * channels);
      fine_logits(model, 0, fine);
      const double step = 1.0 / lattice::resolution(max);
      for (std::uint32_t texel = 0; texel < lattice::texel_count(max); ++texel) {
        const auto [x, y] = lattice::texel_coordinates(texel);
        for (int c = 0; c < channels; ++c)
          // Sums stay below 64 (8 levels of deviation 2): eight roundings of 64 / 2^24 / 2 each.
          ASSERT_NEAR(fine[std::size_t(texel) * channels + c],
                      test::summed_logit(model, 0, x * step, y * step, c), 8 * 0x1p-19)
              << min << " to " << max << ", texel " << texel << ", channel " << c;
      }
    }
}

TEST(Levels, DecomposedLevelsAddUpToTheFunction) {
  const std::uint64_t seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (int min = 0; min <= lattice::max_level; ++min)
    for (int max = min; max <= lattice::max_level; ++max) {
      std::vector<float> fine(std::size_t(lattice::texel_count(max)) * 2), again(fine.size());
      for (float& value : fine) value = float(random.uniform(-8, 8));
      std::vector<float> all(levels::texel_count(min, max) * 2);
      levels::decompose(min, max, 2, fine, all);
      levels::accumulate(min, max, 2, all, again);
      for (std::size_t i = 0; i < fine.size(); ++i)
        // A residual of up to 16 is rounded by 2^-21, and its sum with the others, below 8, by
        // 2^-22.
        ASSERT_NEAR(again[i], fine[i], 0x1p-21 + 0x1p-22) << min << " to " << max << ", " << i;
    }
}

TEST(Levels, AFunctionOfTheCoarsestLevelNeedsNoOther) {
  test::Random random(12);
  std::vector<float> coarse(lattice::texel_count(2)), fine(lattice::texel_count(5));
  for (float& value : coarse) value = float(random.uniform(-8, 8));
  refine_lattice(2, 5, 1, coarse, fine);
  std::vector<float> all(levels::texel_count(2, 5));
  levels::decompose(2, 5, 1, fine, all);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i < coarse.size())
      EXPECT_EQ(all[i], coarse[i]);
    else
      EXPECT_NEAR(all[i], 0, 0x1p-20) << i;  // one rounding of values below 8 on each side
}

TEST(Levels, CoarsenPicksTheTexelsAtTheSamePlaces) {
  std::vector<float> fine(std::size_t(lattice::texel_count(6)) * 2);
  const double step = 1.0 / lattice::resolution(6);
  for (std::uint32_t texel = 0; texel < lattice::texel_count(6); ++texel) {
    const auto [x, y] = lattice::texel_coordinates(texel);
    fine[2 * texel] = float(x * step), fine[2 * texel + 1] = float(y * step);
  }
  for (int level = 0; level <= 6; ++level) {
    std::vector<float> coarse(std::size_t(lattice::texel_count(level)) * 2);
    levels::coarsen(6, level, 2, fine, coarse);
    const double coarse_step = 1.0 / lattice::resolution(level);
    for (std::uint32_t texel = 0; texel < lattice::texel_count(level); ++texel) {
      const auto [x, y] = lattice::texel_coordinates(texel);
      ASSERT_EQ(coarse[2 * texel], x * coarse_step) << level << ", " << texel;
      ASSERT_EQ(coarse[2 * texel + 1], y * coarse_step) << level << ", " << texel;
    }
  }
}

}  // namespace levels_test
}  // namespace tureen::trainer
