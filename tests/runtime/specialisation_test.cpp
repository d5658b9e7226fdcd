// Each specialisation alone: a soup with its trait looks the same, and a soup without it is not
// specialised. docs/specialisations.md cites these tests.
#include "runtime/plan/specialisation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "tests/runtime/specialised_images.hpp"
#include "tests/support/trait_soups.hpp"

namespace tureen::test {
namespace specialisation_test {

RenderPlan plan_of(const TriangleSoup& soup,
                   SpecialisationSet specialisations = SpecialisationSet::all()) {
  return make_plan(soup, DeviceLimits{.software = true}, {.specialisations = specialisations});
}

/// Allowed change of images.
struct Tolerance {
  int steps;
  double channels;  // fraction of channels that may change
};

/// Exact specialisations change nothing, with two exceptions. A network's sums in another order may
/// change the rounding of one channel in 100,000. A shading pass has barycentrics in 16 bits.
/// Rounding can make a bound of half a step a whole step, in any channel.
Tolerance tolerance_of(Specialisation what) {
  switch (what) {
    case Specialisation::shading_pass:
      return {1, 1e-3};
    case Specialisation::harmonics_bands:
    case Specialisation::color_mlp:
    case Specialisation::view_direction:
    case Specialisation::affine_texels:
      return {1, 1.0};
    default:
      return kind_of_trait(what) == Kind::lattice_mlp ? Tolerance{1, 1e-5} : Tolerance{0, 0};
  }
}

struct Case {
  Specialisation what;
  std::uint64_t seed;
};

class Omission : public testing::TestWithParam<Case> {
 protected:
  Specialisation what() const { return GetParam().what; }
  std::uint64_t seed() const { return GetParam().seed; }
  TriangleSoup soup_with_trait() const {
    TriangleSoup soup =
        random_soup(seed(), {.kind = kind_of_trait(what()), .faces = 300, .level = 3, .degree = 4});
    give_trait(what(), soup);
    return soup;
  }
};

TEST_P(Omission, IsPlannedWhereTheSceneHasTheTrait) {
  const TriangleSoup soup = soup_with_trait();
  ASSERT_EQ(defect(soup), std::nullopt);
  const RenderPlan with = plan_of(soup);
  const RenderPlan without = plan_of(soup, SpecialisationSet::all().without(what()));
  EXPECT_TRUE(with.applies(what()));
  EXPECT_FALSE(without.applies(what()));
}

class OmissionImage : public Omission {};

// Compares the generic images with images for three sets: all specialisations, only this one (which
// shows dependencies on others), and all others.
TEST_P(OmissionImage, LosesNothing) {
  const TriangleSoup soup = soup_with_trait();
  const std::vector<Camera> views = four_views(seed());
  const std::vector<Image8> generic = images(soup, views, {.specialise = false});
  const auto [steps, channels] = tolerance_of(what());
  const SpecialisationSet all = SpecialisationSet::all();
  const std::pair<const char*, SpecialisationSet> sets[] = {
      {"all", all}, {"alone", alone(what())}, {"all but this", all.without(what())}};
  for (const auto& [name, specialisations] : sets) {
    EXPECT_EQ(plan_of(soup, specialisations).applies(what()), specialisations.has(what())) << name;
    const Difference found =
        difference(images(soup, views, {.specialisations = specialisations}), generic);
    EXPECT_LE(found.largest, steps) << name;
    EXPECT_LE(double(found.channels), channels * double(found.all_channels)) << name;
    EXPECT_GT(found.covered, 0.05) << "too few pixels to compare";
  }
}

TEST_P(Omission, DoesNotHappenWhereTheSceneLacksTheTrait) {
  const TriangleSoup soup = soup_without_trait(what(), seed());
  const RenderPlan with = plan_of(soup);
  EXPECT_FALSE(with.applies(what()));
  EXPECT_EQ(with.applied(), plan_of(soup, SpecialisationSet::all().without(what())).applied());
}

std::vector<Case> cases(std::initializer_list<std::uint64_t> seeds) {
  std::vector<Case> all;
  for (const SpecialisationName& known : specialisations_of_soups())
    for (const std::uint64_t seed : seeds) all.push_back({known.what, seed});
  return all;
}

/// "alpha-test" as a test's name: "AlphaTest".
std::string test_name(Specialisation what) {
  std::string name;
  bool begins = true;
  for (const char c : std::string(name_of(what))) {
    if (c != '-') name += begins ? char(std::toupper(c)) : c;
    begins = c == '-';
  }
  return name;
}

std::string case_name(const testing::TestParamInfo<Case>& test) {
  return test_name(test.param.what) + "_seed" + std::to_string(test.param.seed);
}

INSTANTIATE_TEST_SUITE_P(All, Omission, testing::ValuesIn(cases({1, 2})), case_name);
INSTANTIATE_TEST_SUITE_P(All, OmissionImage, testing::ValuesIn(cases({1})), case_name);
INSTANTIATE_TEST_SUITE_P(Thorough, OmissionImage, testing::ValuesIn(cases({2})), case_name);

/// This omission has no name, because it cannot be disabled: such a face covers no pixel centre.
TEST(FacesWithoutArea, AreSaidAndChangeNothing) {
  for (const std::uint64_t seed : {1, 2}) {
    const TriangleSoup soup = random_soup(seed, {.kind = Kind::face_colors, .faces = 300});
    TriangleSoup more = soup;
    auto& rgba = std::get<FaceColors>(more.appearance).rgba;
    more.positions.emplace_back(std::numeric_limits<float>::infinity(), 0.0f, 0.0f);
    const auto infinite = std::uint32_t(more.positions.size() - 1);
    for (const glm::uvec3& t : soup.triangles) {
      more.triangles.emplace_back(t.x, t.y, t.y);
      more.triangles.emplace_back(t.x, t.y, infinite);
      rgba.resize(more.triangles.size(), glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
    }
    ASSERT_EQ(defect(more), std::nullopt);
    EXPECT_EQ(plan_of(more).soup(0).undrawable_faces, 600u);
    const std::vector<Camera> views = four_views(seed);
    const Difference found = difference(images(more, views, {}), images(soup, views, {}));
    EXPECT_EQ(found.channels, 0u);
    EXPECT_GT(found.covered, 0.05) << "too few pixels to compare";
  }
}

TEST(SpecialisationNames, AreFoundAgain) {
  for (const SpecialisationName& known : specialisation_names()) {
    EXPECT_STREQ(name_of(known.what), known.name);
    EXPECT_EQ(specialisation_named(known.name), known.what);
  }
  EXPECT_EQ(specialisation_named("everything"), std::nullopt);
}

TEST(SpecialisationNames, OnlyWhatIsAskedForIsOmitted) {
  const TriangleSoup soup = random_soup(1, {.kind = Kind::lattice_mlp, .level = 3});
  EXPECT_TRUE(plan_of(soup, SpecialisationSet()).applied().empty());
  const RenderPlan plan = plan_of(soup, SpecialisationSet::only(Specialisation::background));
  EXPECT_EQ(plan.applied(), std::vector{AppliedSpecialisation{Specialisation::background}});
}

}  // namespace specialisation_test
}  // namespace tureen::test
