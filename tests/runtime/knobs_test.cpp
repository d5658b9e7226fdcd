// Knobs that change the data: what the device shows with a preset against the oracle's picture of
// the soup that the preset makes (soup/preset_data.hpp), and that soup against what it stands for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "runtime/device_forecast.hpp"
#include "runtime/renderer.hpp"
#include "soup/error.hpp"
#include "soup/keep_faces.hpp"
#include "soup/preset_data.hpp"
#include "support/agreement.hpp"
#include "support/random_soups.hpp"

namespace tureen {
namespace {

using test::Drawn;
using test::expect_agreement;
using ::testing::HasSubstr;

gl::Context& context() {
  static gl::Context shared = gl::Context::create({});
  return shared;
}

constexpr int width = 320, height = 240;

Camera camera_for(std::uint64_t seed) {
  test::Random random(seed);
  return test::random_camera(random, width, height);
}

/// Every plan that obeys the preset, against the oracle's picture of the soup it stands for.
void expect_obeyed(const TriangleSoup& soup, const RenderPreset& preset, const Camera& camera) {
  SCOPED_TRACE(describe(preset));
  const auto turned = with_preset(soup, preset);
  const OracleImage oracle =
      test::snapped_oracle(turned ? turned->soup : soup, glm::dvec3(0), camera);
  const auto drawn = [&](const PlanPreferences& plan) {
    return test::draw(context(), soup, glm::dvec3(0), camera, plan);
  };
  const Drawn special = drawn({.site = ShadingSite::deferred, .preset = preset});
  expect_agreement(oracle, special, "specialised");
  expect_agreement(oracle,
                   drawn({.specialise = false, .site = ShadingSite::deferred, .preset = preset}),
                   "generic");
  Drawn forward = drawn({.site = ShadingSite::forward, .preset = preset});
  forward.faces = special.faces;  // forward plans name none, and rasterise alike
  expect_agreement(oracle, forward, "forward");
}

struct Case {
  const char* name;
  RenderPreset preset;
};

using Preset = RenderPreset;
const Case cases[] = {
    {"Level0", {.lattice_level = 0}},
    {"Level2", {.lattice_level = 2}},
    {"Level4", {.lattice_level = 4}},
    {"Bits16", {.texel_bits = 16}},
    {"Bits8", {.texel_bits = 8}},
    {"Bits4", {.texel_bits = 4}},
    {"Base", {.color = Preset::Color::base}},
    {"Degree0", {.color = Preset::Color::harmonics, .harmonics_degree = 0}},
    {"Degree1", {.color = Preset::Color::harmonics, .harmonics_degree = 1}},
    {"Degree2", {.color = Preset::Color::harmonics, .harmonics_degree = 2}},
    {"Degree1Bits16", {.texel_bits = 16, .color = Preset::Color::harmonics, .harmonics_degree = 1}},
    {"Degree2Bits4Level3",
     {.lattice_level = 3,
      .texel_bits = 4,
      .color = Preset::Color::harmonics,
      .harmonics_degree = 2}},
};

class Knob : public ::testing::TestWithParam<std::tuple<Case, bool, bool>> {
 protected:
  const RenderPreset& preset() const { return std::get<0>(GetParam()).preset; }
  TriangleSoup soup(std::uint64_t seed) const {
    const bool mlp = std::get<2>(GetParam());
    // Baking runs the network 32 times a texel: half an hour under the thread sanitizer for 200
    // faces. Fewer have to be larger to cover as much.
    const bool bakes = mlp && preset().color == Preset::Color::harmonics;
    return test::random_soup(seed, {.kind = mlp ? test::Kind::lattice_mlp : test::Kind::lattice,
                                    .faces = bakes ? 24 : 200,
                                    .size = bakes ? 0.45 : 0.15,
                                    .level = -1,
                                    .float_texels = std::get<1>(GetParam())});
  }
};

TEST_P(Knob, IsObeyedAsTheOracleHasIt) {
  SCOPED_TRACE("seed 700");
  expect_obeyed(soup(700), preset(), camera_for(700));
}

TEST_P(Knob, TakesTheBytesThatTheForecastSays) {
  SCOPED_TRACE("seed 701");
  const TriangleSoup stored = soup(701);
  const PlanPreferences plan{.site = ShadingSite::deferred, .preset = preset()};
  context().make_current();
  const Renderer renderer(context(), stored, glm::dvec3(0), {.plan = plan});
  const auto turned = with_preset(stored, preset());
  const TriangleSoup& drawn = turned ? turned->soup : stored;
  const auto forecast =
      device_forecast(drawn, make_plan(drawn, device_limits(context().capabilities()), plan));
  // Stores are whole rows: at most one row of 4096 texels of 16 bytes more, each.
  EXPECT_GE(renderer.device_bytes(), forecast.bytes);
  EXPECT_LE(renderer.device_bytes(), forecast.bytes + 6 * 4096 * 16);
}

INSTANTIATE_TEST_SUITE_P(Case, Knob,
                         ::testing::Combine(::testing::ValuesIn(cases), ::testing::Bool(),
                                            ::testing::Bool()),
                         [](const auto& i) {
                           return std::string(std::get<0>(i.param).name) +
                                  (std::get<1>(i.param) ? "Float" : "Byte") +
                                  (std::get<2>(i.param) ? "Mlp" : "");
                         });

TEST(KnobSentences, SayWhatIsTurnedAndWhatItSaves) {
  const TriangleSoup soup =
      test::random_soup(702, {.kind = test::Kind::lattice_mlp, .faces = 20, .level = 5});
  std::vector<std::uint8_t> keeps(20, 1);
  for (int t = 0; t < 5; ++t) keeps[t] = 0;
  context().make_current();
  const Renderer renderer(context(), soup, glm::dvec3(0),
                          {.plan = {.preset = RenderPreset{.lattice_level = 3,
                                                           .texel_bits = 4,
                                                           .color = Preset::Color::base,
                                                           .triangle_fraction = 0.75,
                                                           .keeps_face = keeps,
                                                           .site = Preset::Site::forward}}});
  const auto& sentences = renderer.plan().sentences;
  const auto text =
      std::accumulate(sentences.begin(), sentences.end(), std::string(),
                      [](const std::string& a, const std::string& b) { return a + b + "\n"; });
  EXPECT_THAT(text, HasSubstr("knob: no lattice above level 3"));
  EXPECT_THAT(text, HasSubstr("knob: the base colour"));
  EXPECT_THAT(text, HasSubstr("knob: 4 bits a texel channel instead of 8"));
  EXPECT_THAT(text, HasSubstr("knob: the most visible 75 % of the triangles"));
  EXPECT_THAT(text, HasSubstr("knob: every fragment is coloured at once"));
  EXPECT_EQ(renderer.plan().site, ShadingSite::forward);
}

TEST(KnobSentences, NothingIsTurnedByAFaithfulPreset) {
  const TriangleSoup soup = test::random_soup(703, {.kind = test::Kind::lattice_mlp});
  const auto plan = [&](const std::optional<RenderPreset>& preset) {
    return make_plan(soup, {}, {.preset = preset}).sentences;
  };
  EXPECT_EQ(plan(RenderPreset{}), plan(std::nullopt));
  EXPECT_FALSE(with_preset(soup, {}));
}

TEST(KnobTriangles, ThoseThatAreNotKeptAreNotThere) {
  for (const test::Kind kind : test::all_kinds) {
    SCOPED_TRACE(to_string(kind));
    const TriangleSoup soup = test::random_soup(704, {.kind = kind, .shared_vertices = true});
    test::Random random(704);
    RenderPreset preset{.triangle_fraction = 0.5};
    std::vector<std::uint32_t> kept;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
      preset.keeps_face.push_back(random.chance(0.5) ? 1 : 0);
      if (preset.keeps_face.back()) kept.push_back(t);
    }
    const TriangleSoup fewer = keep_faces(soup, preset.keeps_face);
    ASSERT_EQ(defect(fewer), std::nullopt);
    ASSERT_EQ(fewer.triangles.size(), kept.size());
    OracleImage oracle = test::snapped_oracle(fewer, glm::dvec3(0), camera_for(704));
    for (std::uint32_t& face : oracle.face)
      if (face != no_face) face = kept[face];
    expect_agreement(oracle,
                     test::draw(context(), soup, glm::dvec3(0), camera_for(704),
                                {.site = ShadingSite::deferred, .preset = preset}),
                     to_string(kind));
  }
}

TEST(KnobRefusals, SayWhy) {
  const TriangleSoup soup = test::random_soup(705, {.kind = test::Kind::lattice_mlp, .level = 2});
  const auto refused = [&](const PlanPreferences& plan) -> std::string {
    try {
      context().make_current();
      const Renderer drawn(context(), soup, glm::dvec3(0), {.plan = plan});
      return "accepted";
    } catch (const UsageError& error) {
      return error.reason();
    }
  };
  EXPECT_THAT(refused({.preset = RenderPreset{.texel_bits = 5}}), HasSubstr("4, 8, 16 or 32"));
  EXPECT_THAT(refused({.preset = RenderPreset{.triangle_fraction = 0.5, .keeps_face = {1, 0}}}),
              HasSubstr("among 2 triangles"));
  EXPECT_THAT(
      refused({.pipeline = PipelineKind::published, .preset = RenderPreset{.lattice_level = 1}}),
      HasSubstr("draws in one way"));
}

}  // namespace
}  // namespace tureen
