// Specialisations in plans, and that they do not change images.
#include "runtime/plan/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/plan/face_alpha.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/runtime/specialised_images.hpp"
#include "tests/support/cutout_cloud.hpp"

namespace tureen::test {
namespace plan_test {

using testing::Contains;

RenderPlan plan_of(const TriangleSoup& soup) { return make_plan(soup, DeviceLimits{}); }

LatticeTexture& lattice_of(TriangleSoup& soup) { return std::get<LatticeTexture>(soup.appearance); }

std::vector<std::uint8_t>& bytes_of(TriangleSoup& soup) {
  return std::get<std::vector<std::uint8_t>>(lattice_of(soup).texels);
}

/// Random soups let some faces share texels; this gives each face separate texels.
void unshare_texels(TriangleSoup& soup, int level) {
  LatticeTexture& texture = lattice_of(soup);
  const std::uint32_t each = lattice::texel_count(level);
  for (std::uint32_t t = 0; t < texture.patches.size(); ++t)
    texture.patches[t] = {t * each, std::uint32_t(level)};
  bytes_of(soup).resize(texture.patches.size() * each * LatticeTexture::channels, 255);
}

/// Calls set(texel, channel values) for every texel of an 8-bit lattice.
template <class Set>
void for_each_texel(TriangleSoup& soup, const Set& set) {
  auto& bytes = bytes_of(soup);
  for (std::size_t i = 0; i < bytes.size(); i += LatticeTexture::channels) set(&bytes[i]);
}

TEST(Plan, OpaqueFacesNeedNoAlphaTest) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice_mlp, .level = 2});
  for_each_texel(soup, [](std::uint8_t* texel) { texel[7] = 128; });
  const RenderPlan plan = plan_of(soup);
  EXPECT_EQ(plan.soup(0).opaque_count, plan.soup(0).faces.size());
  EXPECT_THAT(plan.soup(0).applied,
              Contains(AppliedSpecialisation{Specialisation::alpha_test, plan.soup(0).faces.size(),
                                             plan.soup(0).faces.size()}));
}

TEST(Plan, TransparentFacesAreNotDrawn) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice_mlp, .level = 2});
  for_each_texel(soup, [](std::uint8_t* texel) { texel[7] = 127; });
  const RenderPlan plan = plan_of(soup);
  EXPECT_TRUE(plan.soup(0).faces.empty());
  const std::size_t all = soup.triangles.size();
  EXPECT_THAT(plan.soup(0).applied,
              Contains(AppliedSpecialisation{Specialisation::transparent_faces, all, all}));
}

TEST(Plan, ANetworkThatNeverBlendsInDoesNotRun) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice_mlp, .level = 2});
  ASSERT_TRUE(plan_of(soup).soup(0).color_mlp);
  for_each_texel(soup, [](std::uint8_t* texel) { texel[3] = 0; });
  const RenderPlan plan = plan_of(soup);
  EXPECT_FALSE(plan.soup(0).color_mlp);
  EXPECT_THAT(plan.soup(0).applied, Contains(AppliedSpecialisation{Specialisation::color_mlp}));
  for_each_texel(soup, [](std::uint8_t* texel) { texel[3] = 1; });
  EXPECT_TRUE(plan_of(soup).soup(0).color_mlp) << "1/255 is above the half step allowed";
}

TEST(Plan, ConstantFacesBecomeFaceColoursAndAffineOnesKeepTheirCorners) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice, .level = 3});
  unshare_texels(soup, 3);
  auto& texture = lattice_of(soup);
  auto& bytes = bytes_of(soup);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < lattice::texel_count(3); ++k) {
      std::uint8_t* texel = &bytes[(texture.patches[t].first_texel + std::size_t(k)) * 8];
      for (int c = 0; c < 7; ++c) texel[c] = std::uint8_t(20 * c + int(t % 50));
      texel[7] = 255;
    }
  EXPECT_TRUE(plan_of(soup).soup(0).flat_colors);

  // 8 x + 16 y at level 3 is affine in bytes without rounding.
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < lattice::texel_count(3); ++k) {
      const auto at = lattice::texel_coordinates(k);
      bytes[(texture.patches[t].first_texel + std::size_t(k)) * 8] =
          std::uint8_t(8 * at.x + 16 * at.y);
    }
  const RenderPlan plan = plan_of(soup);
  EXPECT_FALSE(plan.soup(0).flat_colors);
  EXPECT_EQ(plan.soup(0).lattice.uniform_level, 0);
  EXPECT_THAT(plan.soup(0).applied, Contains(AppliedSpecialisation{Specialisation::affine_texels,
                                                                   plan.soup(0).faces.size(),
                                                                   plan.soup(0).faces.size()}));
}

TEST(Plan, AnAffineFaceThatIsCutOutKeepsItsLatticeUnlessItsAlphaIsAffineToo) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice, .level = 3});
  for_each_texel(soup, [](std::uint8_t* texel) { std::fill(texel, texel + 7, std::uint8_t(90)); });
  // The random alphas stay: only opaque faces may lose their texels.
  const RenderPlan plan = plan_of(soup);
  for (std::size_t slot = plan.soup(0).opaque_count; slot < plan.soup(0).faces.size(); ++slot)
    if (!plan.soup(0).lattice.levels.empty()) {
      EXPECT_EQ(plan.soup(0).lattice.levels[slot], 3) << slot;
    }
  EXPECT_NE(plan.soup(0).lattice.uniform_level, 0);
}

TEST(Plan, InvisibleHarmonicsBandsAreDropped) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::face_harmonics, .degree = 3});
  EXPECT_EQ(plan_of(soup).soup(0).harmonics_degree, 3);
  auto& sh = std::get<Harmonics>(soup.appearance);
  for (std::size_t i = 0; i < sh.coefficients.size(); ++i)
    if (i % 16 >= 4) sh.coefficients[i] = glm::vec3(1e-5f);
  const RenderPlan plan = plan_of(soup);
  EXPECT_EQ(plan.soup(0).harmonics_degree, 1);
  ASSERT_EQ(plan.soup(0).applied.back().what, Specialisation::background);
  const AppliedSpecialisation& bands = plan.soup(0).applied[plan.soup(0).applied.size() - 2];
  EXPECT_EQ(bands.what, Specialisation::harmonics_bands);
  EXPECT_EQ(bands.count, 2u);
  EXPECT_EQ(bands.total, 3u);
  EXPECT_GT(bands.margin, 0);
  EXPECT_LE(bands.margin, 0.5);
}

TEST(Plan, DeadNeuronsAreFoundByTheirBound) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice_mlp, .level = 2});
  ColorMlp& mlp = *lattice_of(soup).mlp;
  for (int i = 0; i < 16; ++i) mlp.layers[0].weights[std::size_t(i)] = i < 7 ? -0.1f : 0.0f;
  mlp.layers[0].biases[0] = -0.5f;  // -0.5 - 0.1 (f0 + .. + f6) never reaches 0
  EXPECT_THAT(plan_of(soup).soup(0).applied,
              Contains(AppliedSpecialisation{Specialisation::dead_neurons, 1, 32}));
}

// -1000 + 999.999 f with f = 1 is below 0 by less than the float rounding at this magnitude.
TEST(Plan, ANeuronWithinRoundingOfFiringIsNotDead) {
  ColorMlp mlp;
  mlp.encoding = DirectionEncoding::none;
  mlp.layers = {{1, 1, {999.999f}, {-1000.0f}}, {1, 3, {1, 1, 1}, {0, 0, 0}}};
  FeatureRanges ranges;
  ranges[0] = {1.0f, 1.0f};
  EXPECT_EQ(color_mlp_source(mlp, MlpWeights::constants, ranges).dead_neurons, 0);
  mlp.layers[0].biases[0] = -1001.0f;
  EXPECT_EQ(color_mlp_source(mlp, MlpWeights::constants, ranges).dead_neurons, 1);
}

TEST(Plan, AFaceWithAnAlphaThatIsNoNumberIsTested) {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}};
  for (const int which : {0, 1, 2}) {
    VertexColors colors{{glm::vec4(1), glm::vec4(1), glm::vec4(1)}};
    colors.rgba[std::size_t(which)].a = NAN;
    soup.appearance = colors;
    EXPECT_EQ(classify_alpha(soup).front(), FaceAlpha::cut_out) << which;
  }
}

// Texels that faces partly share are not duplicated: the copies might not fit on any device.
TEST(Plan, TexelsSharedInPartAreNotCopied) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice_mlp, .faces = 50, .level = 3});
  unshare_texels(soup, 3);
  EXPECT_EQ(plan_of(soup).soup(0).lattice.uniform_level, 3);
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    lattice_of(soup).patches[t].first_texel = t;
  EXPECT_EQ(plan_of(soup).soup(0).lattice.uniform_level, -1);
  EXPECT_TRUE(plan_of(soup).soup(0).lattice.levels.empty());
}

TEST(Plan, WithoutSpecialisationNothingIsOmitted) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::lattice_mlp, .level = 2});
  for_each_texel(soup, [](std::uint8_t* texel) { texel[3] = texel[7] = 0; });
  const RenderPlan plan = make_plan(soup, DeviceLimits{}, {.specialise = false});
  EXPECT_EQ(plan.soup(0).faces.size(), soup.triangles.size());
  EXPECT_EQ(plan.soup(0).opaque_count, 0u);
  EXPECT_TRUE(plan.soup(0).color_mlp);
  EXPECT_EQ(plan.soup(0).mlp_weights, MlpWeights::uniforms);
  EXPECT_TRUE(plan.soup(0).applied.empty());
  EXPECT_FALSE(plan.soup(0).depth_rejects_background);
}

TEST(Plan, CoincidentFacesShareAClusterAndABucket) {
  TriangleSoup soup = random_soup(1, {.kind = Kind::face_colors, .faces = 500});
  auto& colors = std::get<FaceColors>(soup.appearance).rgba;
  for (glm::vec4& color : colors) color.a = 1.0f;
  // 200 copies of face 7 cross any cluster border.
  for (int i = 0; i < 200; ++i) {
    soup.triangles.push_back(soup.triangles[7]);
    colors.push_back(colors[7]);
  }
  const RenderPlan plan = plan_of(soup);
  for (const Cluster& cluster : plan.soup(0).clusters) {
    const std::uint32_t end = cluster.first_slot + cluster.slot_count;
    if (end < plan.soup(0).faces.size()) {
      EXPECT_FALSE(coincident(soup, plan.soup(0).faces[end - 1], plan.soup(0).faces[end]));
    }
  }
}

/// Difference between a soup's specialised and generic images.
Difference specialised_against_generic(const TriangleSoup& soup, const std::vector<Camera>& views) {
  return difference(images(soup, views, {}), images(soup, views, {.specialise = false}));
}

struct KindAndSeed {
  Kind kind;
  std::uint64_t seed;
};

class SpecialisedKinds : public testing::TestWithParam<KindAndSeed> {};

// docs/specialisations.md: an exact specialisation changes no pixel. Compiling the network's
// weights into the shader adds the same terms in another order, which may change the rounding of
// one channel in 100,000.
TEST_P(SpecialisedKinds, DrawsWhatTheGenericPlanDraws) {
  const auto [kind, seed] = GetParam();
  const TriangleSoup soup = random_soup(seed, {.kind = kind, .faces = 400, .degenerate = true});
  const Difference found = specialised_against_generic(soup, four_views(seed));
  const bool rounds =
      kind == Kind::lattice || kind == Kind::lattice_mlp || kind == Kind::uv_textures_mlp;
  EXPECT_LE(found.largest, rounds ? 1 : 0);
  EXPECT_LE(found.channels, rounds ? found.all_channels / 100000 : 0);
  EXPECT_GT(found.covered, 0.05) << "too few pixels to compare";
}

TEST(Specialised, DrawsTheCutOutCloudAsTheGenericPlanDoes) {
  const Scene cloud = cutout_cloud({.triangles = 2000, .level = 5, .width = 320, .height = 180});
  ASSERT_GE(cloud.cameras.size(), 4u);
  const auto& soup = only_soup(cloud);
  const std::vector<Camera> views(cloud.cameras.begin(), cloud.cameras.begin() + 4);
  const std::vector<Image8> generic = images(soup, views, {.specialise = false});
  const Difference found = difference(images(soup, views, {}), generic);
  EXPECT_LE(found.largest, 1);
  EXPECT_LE(found.channels, found.all_channels / 100000);
}

// Specialisations that are not exact may change a colour by half a step, which rounding can make a
// whole step.
TEST(Specialised, AffineFacesMoveNoColourByMoreThanAStep) {
  TriangleSoup soup = random_soup(4, {.kind = Kind::lattice, .faces = 300, .level = 3});
  unshare_texels(soup, 3);
  auto& bytes = bytes_of(soup);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < lattice::texel_count(3); ++k) {
      std::uint8_t* texel = &bytes[(lattice_of(soup).patches[t].first_texel + std::size_t(k)) * 8];
      const auto at = lattice::texel_coordinates(k);
      // Multiples of 8 are affine at level 3 without rounding.
      for (int c = 0; c < 7; ++c) texel[c] = std::uint8_t(8 * at.x + 8 * (c % 3) * at.y);
    }
  ASSERT_TRUE(plan_of(soup).applies(Specialisation::affine_texels));
  EXPECT_LE(specialised_against_generic(soup, four_views(4)).largest, 1);
}

TEST(Specialised, DroppedHarmonicsMoveNoColourByMoreThanAStep) {
  TriangleSoup soup = random_soup(5, {.kind = Kind::face_harmonics, .faces = 300, .degree = 3});
  auto& sh = std::get<Harmonics>(soup.appearance);
  Random random(5);
  for (std::size_t i = 0; i < sh.coefficients.size(); ++i)
    // Just below the bound: the sum of three channels in bands 2 and 3.
    if (i % 16 >= 4) sh.coefficients[i] = 3e-4f * glm::vec3(random.direction());
  ASSERT_LT(plan_of(soup).soup(0).harmonics_degree, 3);
  EXPECT_LE(specialised_against_generic(soup, four_views(5)).largest, 1);
}

std::vector<KindAndSeed> kinds_and_seeds() {
  std::vector<KindAndSeed> all;
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 1; seed <= 3; ++seed) all.push_back({kind, seed});
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, SpecialisedKinds, testing::ValuesIn(kinds_and_seeds()),
                         [](const auto& test) {
                           return to_string(test.param.kind) + "_seed" +
                                  std::to_string(test.param.seed);
                         });

}  // namespace plan_test
}  // namespace tureen::test
