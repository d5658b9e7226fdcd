// Counting what is seen, and whether presets keep their promises.
#include "runtime/preset_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numeric>

#include "runtime/visibility_count.hpp"
#include "soup/lattice.hpp"
#include "soup/metrics.hpp"
#include "support/agreement.hpp"
#include "support/random_soups.hpp"

namespace tureen {
namespace {

using ::testing::HasSubstr;

gl::Context& context() {
  static gl::Context shared = gl::Context::create({});
  shared.make_current();
  return shared;
}

std::vector<Camera> cameras(std::uint64_t seed, int count) {
  test::Random random(seed);
  std::vector<Camera> result;
  for (int i = 0; i < count; ++i) result.push_back(test::random_camera(random, 160, 120));
  return result;
}

// -- visibility -----------------------------------------------------------------------------------

TEST(VisibilityCount, IsThePixelsThatTheOracleNames) {
  SCOPED_TRACE("seed 801");
  const TriangleSoup soup = test::random_soup(801, {.kind = test::Kind::lattice});
  const auto views = cameras(801, 3);
  const auto counted = count_visible_pixels(context(), soup, glm::dvec3(0), views);
  std::vector<std::int64_t> expected(soup.triangles.size(), 0);
  for (const Camera& view : views)
    for (const std::uint32_t face : test::snapped_oracle(soup, glm::dvec3(0), view).face)
      if (face != no_face) ++expected[face];
  ASSERT_EQ(counted.size(), expected.size());
  std::int64_t difference = 0, total = 0;
  for (std::size_t t = 0; t < expected.size(); ++t) {
    difference += std::abs(std::int64_t(counted[t]) - expected[t]);
    total += expected[t];
  }
  EXPECT_GT(total, 1000);
  // The budget of tests/support/agreement.hpp, of all pixels, for ties of depth and threshold.
  EXPECT_LE(double(difference), 2e-4 * 3 * 160 * 120);
  EXPECT_EQ(counted, count_visible_pixels(context(), soup, glm::dvec3(0), views));
}

TEST(VisibilityCount, TexelsOfAFaceComeToItsPixels) {
  SCOPED_TRACE("seed 803");
  const TriangleSoup soup = test::random_soup(803, {.kind = test::Kind::lattice});
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  const auto views = cameras(803, 3);
  const auto pixels = count_visible_pixels(context(), soup, glm::dvec3(0), views);
  const auto texels = count_visible_texels(context(), soup, glm::dvec3(0), views);
  ASSERT_EQ(texels.size(), texture.texel_count());
  // By patch, as faces may share theirs.
  std::map<std::uint32_t, std::pair<double, double>> patches;
  for (std::size_t t = 0; t < pixels.size(); ++t) {
    const LatticePatch& patch = texture.patches[t];
    auto& [expected, counted] = patches[patch.first_texel];
    expected += double(pixels[t]);
    counted = 0;
    for (std::uint32_t i = 0; i < lattice::texel_count(int(patch.level)); ++i)
      counted += double(texels[patch.first_texel + i]);
  }
  double total = 0, missing = 0;
  for (const auto& [first, counts] : patches) {
    // Weights of a pixel come to one, but for the rounding of as many floats.
    EXPECT_LE(counts.second, counts.first * (1 + 1e-5)) << "patch at " << first;
    total += counts.first;
    missing += counts.first - counts.second;
  }
  EXPECT_GT(total, 1000);
  // Corners on a grid of 1/256 of a pixel move few edges across a centre.
  EXPECT_LE(missing, 2e-3 * total);
}

TEST(VisibilityCount, TexelsBehindOthersAreNotShown) {
  // Two faces of level 2, and before the second a third one that hides a part of it.
  TriangleSoup soup;
  soup.positions = {{-2, 0, 0}, {-1, 0, 0},     {-2, 1, 0},     {0, 0, 0},    {1, 0, 0},
                    {0, 1, 0},  {-.5, -.5, .1}, {2.1, -.5, .1}, {-.5, .8, .1}};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  LatticeTexture texture;
  texture.patches = {{0, 2}, {15, 2}, {30, 2}};
  texture.texels = std::vector<std::uint8_t>(45 * LatticeTexture::channels, 255);
  soup.appearance = std::move(texture);
  const Camera camera = look_at({0, 0.3, 50}, {0, 0.3, 0}, {0, 1, 0}, 0.06, 400, 300);
  const auto shown = count_visible_texels(context(), soup, glm::dvec3(0), std::array{camera});
  for (std::size_t i = 0; i < 15; ++i) EXPECT_GT(shown[i], 100.0f) << i;
  int hidden = 0;
  for (std::size_t i = 0; i < 15; ++i) {
    // Texel (x, y) of the second face lies at the world's (y/4, 1 - x/4 - y/4); what is hidden lies
    // under the line from (2.1, -.5) to (-.5, .8).
    const auto at = lattice::texel_coordinates(std::uint32_t(i));
    const double across = at.y / 4.0, up = 1 - at.x / 4.0 - at.y / 4.0;
    const double above = up - (0.55 - 0.5 * across);
    // A texel reaches a quarter to each side: pixels within it take some of it.
    if (above > 0.05) {
      EXPECT_GT(shown[15 + i], 1.0f) << i;
    } else if (above < -0.26) {
      EXPECT_EQ(shown[15 + i], 0.0f) << i;
      ++hidden;
    }
  }
  EXPECT_EQ(hidden, 4);
}

TEST(VisibilityCount, FlatSoupsAreCountedToo) {
  SCOPED_TRACE("seed 802");
  const TriangleSoup soup = test::random_soup(802, {.kind = test::Kind::face_colors});
  const auto counted = count_visible_pixels(context(), soup, glm::dvec3(0), cameras(802, 1));
  EXPECT_GT(std::accumulate(counted.begin(), counted.end(), std::uint64_t(0)), 1000u);
}

TEST(VisibilityCount, TheMostVisibleAreKeptStably) {
  const std::vector<std::uint64_t> pixels = {5, 0, 9, 5, 1, 0};
  using Keeps = std::vector<std::uint8_t>;
  EXPECT_EQ(most_visible(pixels, 1.0), Keeps({1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(most_visible(pixels, 0.5), Keeps({1, 0, 1, 1, 0, 0}));
  EXPECT_EQ(most_visible(pixels, 0.33), Keeps({1, 0, 1, 0, 0, 0}));
  EXPECT_EQ(most_visible(pixels, 0.01), Keeps({0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(most_visible(pixels, 0.84), Keeps({1, 1, 1, 1, 1, 0}));
  EXPECT_EQ(most_visible({}, 0.5), Keeps());

  RenderPreset preset;
  set_triangle_fraction(preset, pixels, 0.5);
  EXPECT_EQ(defect(preset), std::nullopt);
  EXPECT_EQ(preset.keeps_face, most_visible(pixels, 0.5));
  set_triangle_fraction(preset, pixels, 1.0);
  EXPECT_TRUE(is_faithful(preset));
  set_triangle_fraction(preset, {}, 0.5);
  EXPECT_EQ(defect(preset), std::nullopt);
}

// What no view shows changes no view.
TEST(VisibilityCount, LeavingOutWhatIsNotSeenChangesNothing) {
  SCOPED_TRACE("seed 803");
  const TriangleSoup soup = test::random_soup(803, {.kind = test::Kind::lattice_mlp});
  const auto views = cameras(803, 2);
  const auto pixels = count_visible_pixels(context(), soup, glm::dvec3(0), views);
  std::size_t seen = 0;
  for (const std::uint64_t count : pixels) seen += count > 0 ? 1 : 0;
  ASSERT_LT(seen, pixels.size());
  const TriangleSoup fewer = keep_most_visible(soup, pixels, double(seen) / double(pixels.size()));
  EXPECT_EQ(fewer.triangles.size(), seen);
  for (const Camera& view : views) {
    const auto all = test::draw(context(), soup, glm::dvec3(0), view);
    const auto some = test::draw(context(), fewer, glm::dvec3(0), view);
    // Other clusters, the same pictures.
    EXPECT_TRUE(all.color.pixels == some.color.pixels);
  }
}

// -- promises -------------------------------------------------------------------------------------

Scene scene_of(std::uint64_t seed) {
  Scene scene;
  scene.primitives = test::random_soup(seed, {.kind = test::Kind::lattice_mlp, .level = 4});
  return scene;
}

CheckedRenderer checked(const Scene& scene, const RenderPreset& preset,
                        PipelineKind pipeline = PipelineKind::tureen) {
  return checked_renderer(context(), std::get<TriangleSoup>(scene.primitives), scene.origin,
                          {.plan = {.pipeline = pipeline}}, {preset, preset_views(scene)});
}

TEST(PresetCheck, HasFourViewsOfTheScene) {
  Scene scene = scene_of(810);
  EXPECT_EQ(preset_views(scene).size(), 4u);
  scene.cameras = cameras(810, 5);
  const auto views = preset_views(scene);
  ASSERT_EQ(views.size(), 4u);
  EXPECT_EQ(views[0].view_from_world, scene.cameras[0].view_from_world);
  EXPECT_EQ(views[1].view_from_world, scene.cameras[2].view_from_world);
  EXPECT_EQ(views[0].width, 64);  // 160 / 4 is less than the least
  auto& soup = std::get<TriangleSoup>(scene.primitives);
  for (const Camera& view : views) {
    Renderer renderer(context(), soup, scene.origin, {.plan = {.site = ShadingSite::deferred}});
    renderer.draw(view);
    std::size_t covered = 0;
    for (const std::uint32_t face : renderer.read_faces()) covered += face != no_face ? 1 : 0;
    EXPECT_GT(covered, 20u);
  }
}

TEST(PresetCheck, APromiseThatIsKeptIsObeyed) {
  SCOPED_TRACE("seed 811");
  const Scene scene = scene_of(811);
  RenderPreset preset{.lattice_level = 3};
  const double psnr = measured_promise(context(), scene, preset);
  EXPECT_GT(psnr, 10);
  EXPECT_LT(psnr, 60);
  preset.promised_psnr_db = psnr;
  const CheckedRenderer kept = checked(scene, preset);
  EXPECT_TRUE(kept.obeys_preset);
  EXPECT_THAT(kept.sentence, HasSubstr("is obeyed"));
  EXPECT_THAT(kept.sentence, HasSubstr("lattice level at most 3"));
  EXPECT_THAT(kept.renderer.plan().sentences[1], HasSubstr("knob: no lattice above level 3"));
}

TEST(PresetCheck, APromiseThatIsBrokenIsNot) {
  SCOPED_TRACE("seed 811");
  const Scene scene = scene_of(811);
  RenderPreset preset{.lattice_level = 0};
  preset.promised_psnr_db = measured_promise(context(), scene, preset) + 1;
  CheckedRenderer broken = checked(scene, preset);
  EXPECT_FALSE(broken.obeys_preset);
  EXPECT_THAT(broken.sentence, HasSubstr("is not obeyed"));
  EXPECT_THAT(broken.sentence, HasSubstr("on four views"));
  Renderer faithful(context(), std::get<TriangleSoup>(scene.primitives), scene.origin,
                    RenderOptions{});
  EXPECT_EQ(psnr_between(faithful, broken.renderer, preset_views(scene)), 100);
}

// What the caller asks for is drawn whether or not the scene's preset is, and is no part of what
// the preset is held against.
TEST(PresetCheck, WhatIsAskedForIsObeyedInAnyCase) {
  SCOPED_TRACE("seed 813");
  const Scene scene = scene_of(813);
  const auto asked = [&](RenderPreset preset) {
    return checked_renderer(context(), std::get<TriangleSoup>(scene.primitives), scene.origin,
                            {.plan = {.preset = RenderPreset{.supersampling = 2}}},
                            {preset, preset_views(scene)});
  };
  RenderPreset harmless{.texel_bits = 16, .resolution_scale = 0.5, .promised_psnr_db = 30.0};
  CheckedRenderer kept = asked(harmless);
  EXPECT_TRUE(kept.obeys_preset) << kept.sentence;
  EXPECT_EQ(kept.renderer.plan().supersampling, 2);
  EXPECT_EQ(kept.renderer.plan().resolution_scale, 1);
  const CheckedRenderer broken = asked({.lattice_level = 0, .promised_psnr_db = 99.0});
  EXPECT_FALSE(broken.obeys_preset);
  EXPECT_EQ(broken.renderer.plan().supersampling, 2);
}

TEST(PresetCheck, WhatCannotBeObeyedIsSaid) {
  const Scene scene = scene_of(812);
  EXPECT_THAT(checked(scene, {.lattice_level = 2}, PipelineKind::published).sentence,
              HasSubstr("not obeyed: the published pipeline draws in one way"));
  EXPECT_THAT(checked(scene, {.triangle_fraction = 0.5, .keeps_face = {1}}).sentence,
              HasSubstr("not obeyed: the preset chooses among 1 triangles"));
  const CheckedRenderer unpromised = checked(scene, {.lattice_level = 2});
  EXPECT_TRUE(unpromised.obeys_preset);
  EXPECT_THAT(unpromised.sentence, HasSubstr("promises nothing"));
  EXPECT_EQ(checked(scene, {}).sentence, "");
}

}  // namespace
}  // namespace tureen
