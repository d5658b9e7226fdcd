// Shading as compute draws the same images as the fragment stage. Also tests the plan's choice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/runtime/quality_drawing.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace shading_stage_test {

PlanPreferences deferred(ShadingStage stage) {
  return {.site = ShadingSite::deferred, .shading_stage = stage};
}

// -- the images ---------------------------------------------------------------------------------

constexpr NamedContext contexts[] = {
    {"osmesa", osmesa},
    {"egl_core", {.backend = gl::Backend::egl}},
    {"egl_es31", {.backend = gl::Backend::egl, .api = gl::Api::es, .major = 3, .minor = 1}}};

/// Every byte must match: both stages call the same function with the same numbers. A GPU's
/// compiler might contract products and sums in only one of them; no GPU was tested.
void expect_same(const gl::Context& context, const TriangleSoup& soup,
                 std::span<const Camera> cameras, RenderOptions options, const std::string& what) {
  options.plan.shading_stage = ShadingStage::fragment;
  Renderer fragment = renderer_of(context, soup, {}, options);
  options.plan.shading_stage = ShadingStage::compute;
  Renderer compute = renderer_of(context, soup, {}, options);
  for (const Camera& camera : cameras) {
    fragment.draw({camera});
    compute.draw({camera});
    const Image8 expected = fragment.read_color(), actual = compute.read_color();
    ASSERT_EQ(actual.pixels.size(), expected.pixels.size()) << what;
    std::size_t different = 0;
    for (std::size_t i = 0; i < actual.pixels.size(); ++i)
      different += actual.pixels[i] != expected.pixels[i];
    EXPECT_EQ(different, 0u) << what << ", of " << camera.width << "x" << camera.height;
  }
}

class ShadingStagesOfKind : public testing::TestWithParam<InContext<Kind>> {};

TEST_P(ShadingStagesOfKind, ShowTheSameAtOddSizes) {
  const auto& [named, kind] = GetParam();
  const gl::Context context = gl::Context::create(named.request);
  if (!context.capabilities().compute_shaders) GTEST_SKIP() << "no compute shaders";
  const std::vector<Camera> cameras{camera_of(1, 1), camera_of(7, 5), camera_of(641, 359)};
  for (const std::uint64_t seed : {31, 32})
    expect_same(
        context,
        random_soup(seed,
                    {.kind = kind, .faces = 80, .size = 0.3, .degenerate = true, .degree = 2}),
        cameras, {.plan = deferred({})}, "seed " + std::to_string(seed));
}

INSTANTIATE_TEST_SUITE_P(, ShadingStagesOfKind, in_contexts(all_kinds, contexts), name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, ShadingStagesOfKind, in_other_contexts(all_kinds, contexts),
                         name_in_context);

class ShadingStages : public testing::TestWithParam<NamedContext> {
 protected:
  void SetUp() override {
    if (!context_.capabilities().compute_shaders) GTEST_SKIP() << "no compute shaders";
  }

  gl::Context context_ = gl::Context::create(GetParam().request);
};

TEST_P(ShadingStages, ShowTheSameOverEveryBackground) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const std::vector<Camera> camera{camera_of(63, 41)};
  const glm::vec4 backgrounds[] = {{0.2f, 0.5f, 0.7f, 1}, {1, 1, 1, 0.5f}, {0, 0, 0, 0}};
  PlanPreferences shades_background = deferred({});
  shades_background.specialisations = SpecialisationSet::all().without(Specialisation::background);
  PlanPreferences generic = deferred({});
  generic.specialise = false;
  for (const glm::vec4& background : backgrounds)
    for (const PlanPreferences& plan : {deferred({}), shades_background, generic})
      expect_same(context_, soup, camera, {.plan = plan, .background = background},
                  "background of alpha " + std::to_string(background.a));
  const TriangleSoup nothing{.positions = {}, .triangles = {}, .appearance = FaceColors{}};
  expect_same(context_, nothing, camera, {.plan = deferred({}), .background = backgrounds[0]},
              "no face");
}

TEST_P(ShadingStages, ShowTheSameWithEveryQuality) {
  const std::vector<Camera> camera{camera_of(61, 47)};
  for (const Quality& quality : {Quality{.supersampling = 3}, Quality{.resolution_scale = 0.5}})
    expect_same(context_, soup_of(Kind::lattice_mlp), camera, options_with(quality),
                describe(quality));
  expect_same(context_, soup_of(Kind::lattice_mlp), camera,
              {.plan = {.site = ShadingSite::forward}}, "forward");
}

TEST_P(ShadingStages, TakeTurnsWithoutATrace) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const Camera cameras[] = {camera_of(64, 48), camera_of(37, 61)};
  Renderer fragment = renderer_of(context_, soup, {}, {.plan = deferred(ShadingStage::fragment)});
  Renderer compute = renderer_of(context_, soup, {}, {.plan = deferred(ShadingStage::compute)});
  for (int round = 0; round < 3; ++round)
    for (const Camera& camera : cameras) {
      fragment.draw({camera});
      compute.draw({camera});
      const Image8 computed = compute.read_color();
      EXPECT_EQ(computed.pixels, fragment.read_color().pixels);
      EXPECT_EQ(faces_of(compute), faces_of(fragment));
    }
}

INSTANTIATE_TEST_SUITE_P(Contexts, ShadingStages, testing::ValuesIn(contexts), context_name);

// -- the plan -------------------------------------------------------------------------------------

TEST(ShadingStagePlan, IsTheFragmentStageUnlessComputeIsAskedFor) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const auto planned = [&](bool compute_shaders, const PlanPreferences& preferences) {
    return make_plan(soup, {.compute_shaders = compute_shaders}, preferences).soup(0).shading_stage;
  };
  EXPECT_EQ(planned(true, {}), ShadingStage::fragment);
  EXPECT_EQ(planned(true, deferred(ShadingStage::compute)), ShadingStage::compute);
  EXPECT_THROW(planned(false, deferred(ShadingStage::compute)), DeviceLimitError);
}

TEST(ShadingStagePlan, IsComputeOnlyWhereThePlanIsDeferred) {
  const DeviceLimits limits{.compute_shaders = true};
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const auto plan_of = [&](PlanPreferences preferences) {
    preferences.shading_stage = ShadingStage::compute;
    return make_plan(soup, limits, preferences);
  };
  const RenderPlan forward = plan_of({.site = ShadingSite::forward});
  EXPECT_EQ(forward.soup(0).shading_stage, ShadingStage::fragment);
  EXPECT_EQ(forward.requested_stage, ShadingStage::compute);
  EXPECT_EQ(plan_of({}).soup(0).shading_stage, ShadingStage::compute);
}

}  // namespace shading_stage_test
}  // namespace tureen::test
