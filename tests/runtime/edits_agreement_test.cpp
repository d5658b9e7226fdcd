// Edited soups (scene/edit/edits.hpp): the device's image compared with the oracle's, and its
// memory with the forecast.
#include <gtest/gtest.h>

#include "runtime/device_forecast.hpp"
#include "runtime/renderer.hpp"
#include "scene/edit/edits.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/samples.hpp"

namespace tureen {
namespace edits_agreement_test {

using test::Drawn;
using test::expect_agreement;

gl::Context& context() {
  static gl::Context shared = gl::Context::create({});
  return shared;
}

constexpr int width = 320, height = 240;

Camera camera_for(std::uint64_t seed) {
  test::Random random(seed);
  return test::random_camera(random, width, height);
}

struct Case {
  const char* name;
  Edits edits;
};

const Case cases[] = {
    {"Level0", {.lattice_level = 0}},
    {"Level2", {.lattice_level = 2}},
    {"Level4", {.lattice_level = 4}},
    {"Bytes", {.byte_texels = true}},
    {"Base", {.color = Edits::Color::base}},
    {"Baked", {.color = Edits::Color::baked}},
    {"BakedBytesLevel3", {.lattice_level = 3, .color = Edits::Color::baked, .byte_texels = true}},
};

class EditedSoup : public ::testing::TestWithParam<std::tuple<Case, bool, bool>> {
 protected:
  TriangleSoup soup(std::uint64_t seed) const {
    const auto& [of_case, floats, mlp] = GetParam();
    // Baking evaluates the network 26 times per texel: half an hour under the thread sanitizer for
    // 200 faces. Fewer faces must be larger to cover as much.
    const bool bakes = mlp && of_case.edits.color == Edits::Color::baked;
    const TriangleSoup stored =
        test::random_soup(seed, {.kind = mlp ? test::Kind::lattice_mlp : test::Kind::lattice,
                                 .faces = bakes ? 24 : 200,
                                 .size = bakes ? 0.45 : 0.15,
                                 .level = -1,
                                 .float_texels = floats});
    return edited(stored, of_case.edits);
  }
};

TEST_P(EditedSoup, IsDrawnAsTheOracleHasIt) {
  SCOPED_TRACE("seed 700");
  const TriangleSoup drawn = soup(700);
  ASSERT_EQ(defect(drawn), std::nullopt);
  const Camera camera = camera_for(700);
  const OracleImage oracle = test::snapped_oracle(drawn, glm::dvec3(0), camera);
  const auto draw = [&](const PlanPreferences& plan) {
    return test::draw(context(), drawn, glm::dvec3(0), camera, plan);
  };
  const Drawn special = draw({.site = ShadingSite::deferred});
  expect_agreement(oracle, special, "specialised");
  expect_agreement(oracle, draw({.specialise = false, .site = ShadingSite::deferred}), "generic");
  Drawn forward = draw({.site = ShadingSite::forward});
  forward.faces = special.faces;  // forward plans have no face buffer; the coverage is the same
  expect_agreement(oracle, forward, "forward");
}

TEST_P(EditedSoup, TakesTheBytesThatTheForecastSays) {
  SCOPED_TRACE("seed 701");
  const TriangleSoup drawn = soup(701);
  const PlanPreferences plan{.site = ShadingSite::deferred};
  context().make_current();
  const Renderer renderer = renderer_of(context(), drawn, glm::dvec3(0), {.plan = plan});
  const auto forecast = device_forecast(
      drawn, make_plan(drawn, device_limits(context().capabilities()), plan).soup(0));
  // Stores are padded to whole rows: each by at most one row of 4096 texels with 16 bytes.
  EXPECT_GE(renderer.device_bytes(), forecast.bytes);
  EXPECT_LE(renderer.device_bytes(), forecast.bytes + 6 * 4096 * 16);
}

constexpr auto case_name = [](const auto& i) {
  return std::string(std::get<0>(i.param).name) + (std::get<1>(i.param) ? "Float" : "Byte") +
         (std::get<2>(i.param) ? "Mlp" : "");
};
INSTANTIATE_TEST_SUITE_P(Case, EditedSoup, test::with_flags(cases), case_name);
INSTANTIATE_TEST_SUITE_P(Thorough, EditedSoup, test::with_other_flags(cases), case_name);

TEST(FewerFaces, AreDrawnAsTheOracleHasThem) {
  for (const test::Kind kind : test::all_kinds) {
    SCOPED_TRACE(to_string(kind));
    const TriangleSoup soup = test::random_soup(704, {.kind = kind, .shared_vertices = true});
    test::Random random(704);
    Edits edits;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      edits.keeps_face.push_back(random.chance(0.5) ? 1 : 0);
    const TriangleSoup fewer = edited(soup, edits);
    ASSERT_EQ(defect(fewer), std::nullopt);
    expect_agreement(test::snapped_oracle(fewer, glm::dvec3(0), camera_for(704)),
                     test::draw(context(), fewer, glm::dvec3(0), camera_for(704),
                                {.site = ShadingSite::deferred}),
                     to_string(kind));
  }
}

}  // namespace edits_agreement_test
}  // namespace tureen
