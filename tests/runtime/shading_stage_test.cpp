// Shading as compute shows what the fragment stage shows; what plans make of the wish; and the
// choice by measurement, with a clock of the test's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/choose_shading_stage.hpp"
#include "runtime/knob_drawing.hpp"
#include "soup/error.hpp"
#include "support/contexts.hpp"

namespace tureen::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

PlanPreferences deferred(ShadingStage stage) {
  return {.site = ShadingSite::deferred, .shading_stage = stage};
}

// -- the pictures ---------------------------------------------------------------------------------

class ShadingStages : public testing::TestWithParam<NamedContext> {
 protected:
  void SetUp() override {
    if (!context_.capabilities().compute_shaders) GTEST_SKIP() << "no compute shaders";
  }

  /// To the byte: both stages call the same function with the same numbers. A GPU's compiler might
  /// contract products and sums otherwise in one of them; none has been at hand.
  void expect_same(const TriangleSoup& soup, std::span<const Camera> cameras, RenderOptions options,
                   const std::string& what) {
    options.plan.shading_stage = ShadingStage::fragment;
    Renderer fragment(context_, soup, {}, options);
    options.plan.shading_stage = ShadingStage::compute;
    Renderer compute(context_, soup, {}, options);
    for (const Camera& camera : cameras) {
      fragment.draw(camera);
      compute.draw(camera);
      const Image8 expected = fragment.read_color(), actual = compute.read_color();
      ASSERT_EQ(actual.pixels.size(), expected.pixels.size()) << what;
      std::size_t different = 0;
      for (std::size_t i = 0; i < actual.pixels.size(); ++i)
        different += actual.pixels[i] != expected.pixels[i];
      EXPECT_EQ(different, 0u) << what << ", of " << camera.width << "x" << camera.height;
    }
  }

  gl::Context context_ = gl::Context::create(GetParam().request);
};

TEST_P(ShadingStages, ShowTheSameOfEveryAppearanceAtOddSizes) {
  const std::vector<Camera> cameras{camera_of(1, 1), camera_of(7, 5), camera_of(641, 359)};
  for (const Kind kind : all_kinds)
    for (const std::uint64_t seed : {31, 32})
      expect_same(
          random_soup(seed,
                      {.kind = kind, .faces = 80, .size = 0.3, .degenerate = true, .degree = 2}),
          cameras, {.plan = deferred({})}, to_string(kind) + ", seed " + std::to_string(seed));
}

TEST_P(ShadingStages, ShowTheSameOverEveryBackground) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const std::vector<Camera> camera{camera_of(63, 41)};
  const glm::vec4 backgrounds[] = {{0.2f, 0.5f, 0.7f, 1}, {1, 1, 1, 0.5f}, {0, 0, 0, 0}};
  PlanPreferences shades_background = deferred({});
  shades_background.leave_out = LeaveOutSet::all().without(LeaveOut::background);
  PlanPreferences generic = deferred({});
  generic.specialise = false;
  for (const glm::vec4& background : backgrounds)
    for (const PlanPreferences& plan : {deferred({}), shades_background, generic})
      expect_same(soup, camera, {.plan = plan, .background = background},
                  "background of alpha " + std::to_string(background.a));
  const TriangleSoup nothing{.positions = {}, .triangles = {}, .appearance = FaceColors{}};
  expect_same(nothing, camera, {.plan = deferred({}), .background = backgrounds[0]}, "no face");
}

TEST_P(ShadingStages, ShowTheSameWithEveryKnob) {
  const RenderPreset presets[] = {
      {.supersampling = 3},
      {.resolution_scale = 0.5},
      {.feature_storage = RenderPreset::FeatureStorage::rgba8},
      {.feature_storage = RenderPreset::FeatureStorage::rgba16f, .supersampling = 2},
      {.site = RenderPreset::Site::forward},
      {.alpha_to_coverage = 4}};
  const std::vector<Camera> camera{camera_of(61, 47)};
  for (const RenderPreset& preset : presets)
    expect_same(soup_of(Kind::lattice_mlp), camera, options_with(preset), describe(preset));
}

TEST_P(ShadingStages, AreMeasuredInTheFirstFrameAndSayWhichItIs) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  DeviceLimits hardware = device_limits(context_.capabilities());
  hardware.software = false;  // pretended: a processor's plan would not measure
  Renderer renderer(context_, soup, {}, {.plan = deferred({}), .limits = hardware});
  EXPECT_EQ(renderer.plan().shading_stage, ShadingStage::measured);
  EXPECT_THAT(renderer.plan().sentences, Not(Contains(StartsWith("shading runs"))));
  const std::size_t before = renderer.plan().sentences.size();
  for (const glm::ivec2 size : {glm::ivec2(61, 47), {62, 47}, {256, 256}, {9, 9}}) {
    const Camera camera = camera_of(size.x, size.y);
    renderer.draw(camera);
    EXPECT_THAT(renderer.plan().sentences, Contains(StartsWith("shading runs")));
    EXPECT_EQ(renderer.plan().sentences.size(), before + 1);
    const RenderOptions fragment{.plan = deferred(ShadingStage::fragment), .limits = hardware};
    EXPECT_EQ(renderer.read_color().pixels, draw(context_, soup, camera, fragment).pixels);
  }
  // As little as one pixel more is not measured again: the sentence, with its figures, stays.
  renderer.draw(camera_of(256, 256));
  const std::string measured = renderer.plan().sentences.back();
  renderer.draw(camera_of(257, 256));
  EXPECT_EQ(renderer.plan().sentences.back(), measured);
}

TEST_P(ShadingStages, TakeTurnsWithoutATrace) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const Camera cameras[] = {camera_of(64, 48), camera_of(37, 61)};
  Renderer fragment(context_, soup, {}, {.plan = deferred(ShadingStage::fragment)});
  Renderer compute(context_, soup, {}, {.plan = deferred(ShadingStage::compute)});
  for (int round = 0; round < 3; ++round)
    for (const Camera& camera : cameras) {
      fragment.draw(camera);
      compute.draw(camera);
      const Image8 computed = compute.read_color();
      EXPECT_EQ(computed.pixels, fragment.read_color().pixels);
      EXPECT_EQ(compute.read_faces(), fragment.read_faces());
    }
}

constexpr NamedContext contexts[] = {
    {"osmesa", osmesa},
    {"egl_core", {.backend = gl::Backend::egl}},
    {"egl_es31", {.backend = gl::Backend::egl, .api = gl::Api::es, .major = 3, .minor = 1}}};
INSTANTIATE_TEST_SUITE_P(Contexts, ShadingStages, testing::ValuesIn(contexts),
                         [](const auto& each) { return each.param.name; });

// -- the plan -------------------------------------------------------------------------------------

TEST(ShadingStagePlan, IsMeasuredOnHardwareWithComputeShadersOnly) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const auto planned = [&](bool compute_shaders, bool software, ShadingStage wanted) {
    return make_plan(soup, {.compute_shaders = compute_shaders, .software = software},
                     deferred(wanted))
        .shading_stage;
  };
  EXPECT_EQ(planned(true, false, ShadingStage::measured), ShadingStage::measured);
  EXPECT_EQ(planned(true, true, ShadingStage::measured), ShadingStage::fragment);
  EXPECT_EQ(planned(false, false, ShadingStage::measured), ShadingStage::fragment);
  EXPECT_EQ(planned(true, true, ShadingStage::compute), ShadingStage::compute);
  EXPECT_EQ(planned(true, false, ShadingStage::fragment), ShadingStage::fragment);
  EXPECT_THROW(planned(false, false, ShadingStage::compute), DeviceLimitError);
}

TEST(ShadingStagePlan, SaysWhyNothingIsShadedAsCompute) {
  const DeviceLimits limits{.compute_shaders = true};
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const auto plan_of = [&](const RenderPreset& preset) {
    PlanPreferences preferences = with(preset);
    preferences.shading_stage = ShadingStage::compute;
    const RenderPlan plan = make_plan(soup, limits, preferences);
    return std::pair(plan.shading_stage, plan.sentences);
  };
  const auto [stored, stored_says] =
      plan_of({.feature_storage = RenderPreset::FeatureStorage::rgba8});
  EXPECT_EQ(stored, ShadingStage::fragment);
  EXPECT_THAT(stored_says, Contains(HasSubstr("are shaded in the fragment stage, not as compute")));
  const auto [forward, forward_says] = plan_of({.site = RenderPreset::Site::forward});
  EXPECT_EQ(forward, ShadingStage::fragment);
  EXPECT_THAT(forward_says, Contains(HasSubstr("nothing is shaded as compute")));
  const auto [asked, asked_says] = plan_of({});
  EXPECT_EQ(asked, ShadingStage::compute);
  EXPECT_THAT(asked_says, Contains("shading runs as compute, as asked"));

  PlanPreferences published{.pipeline = PipelineKind::published};
  published.shading_stage = ShadingStage::compute;
  const TriangleSoup one_level = random_soup(21, {.kind = Kind::lattice_mlp, .level = 1});
  EXPECT_THROW(make_plan(one_level, limits, published), UsageError);
}

// -- the choice -----------------------------------------------------------------------------------

/// A device whose passes last what the test says.
class FakeDevice {
 public:
  /// Milliseconds of the i-th pass of a stage.
  std::function<double(ShadingStage, int)> pass_ms;

  StageChoice choose() {
    return choose_shading_stage({.shade =
                                     [this](ShadingStage stage) {
                                       int& count = counts[stage == ShadingStage::compute];
                                       pending_ += pass_ms(stage, count++) / 1000;
                                       order += stage == ShadingStage::compute ? 'c' : 'f';
                                     },
                                 .finish =
                                     [this] {
                                       now_ += pending_;
                                       pending_ = 0;
                                     },
                                 .clock = [this] { return now_; }});
  }

  int counts[2] = {0, 0};
  std::string order;

 private:
  double now_ = 0, pending_ = 0;
};

TEST(ChooseShadingStage, TakesComputeWhereItIsFaster) {
  FakeDevice device;
  device.pass_ms = [](ShadingStage stage, int) {
    return stage == ShadingStage::compute ? 4.2 : 6.1;
  };
  const StageChoice choice = device.choose();
  EXPECT_EQ(choice.stage, ShadingStage::compute);
  EXPECT_NEAR(choice.fragment_ms, 6.1, 1e-9);
  EXPECT_NEAR(choice.compute_ms, 4.2, 1e-9);
  EXPECT_NEAR(choice.spread_ms, 0, 1e-9);
  EXPECT_THAT(sentence_of(choice),
              StartsWith("shading runs as compute: 4.2 ms against 6.1 ms in the fragment stage"));
  EXPECT_EQ(device.order,
            "cff"
            "fcfcfcfcfcfcfc");
}

TEST(ChooseShadingStage, StaysInTheFragmentStageWhereThatIsFaster) {
  FakeDevice device;
  device.pass_ms = [](ShadingStage stage, int) {
    return stage == ShadingStage::compute ? 0.61 : 0.42;
  };
  const StageChoice choice = device.choose();
  EXPECT_EQ(choice.stage, ShadingStage::fragment);
  EXPECT_THAT(sentence_of(choice),
              StartsWith("shading runs in the fragment stage: 0.42 ms against 0.61 ms as compute"));
  // Five passes of 0.42 ms make a turn of two milliseconds.
  EXPECT_EQ(device.counts[0], 2 + 7 * 5);
  EXPECT_EQ(device.counts[1], 1 + 7 * 5);
}

TEST(ChooseShadingStage, IgnoresWhatTheSpreadExplains) {
  FakeDevice device;
  // Compute is a tenth faster, but turns differ by a fifth.
  device.pass_ms = [](ShadingStage stage, int i) {
    const double jitter = i % 3 == 0 ? 1 : i % 3 == 1 ? -1 : 0;
    return (stage == ShadingStage::compute ? 9.0 : 10.0) + jitter;
  };
  const StageChoice choice = device.choose();
  EXPECT_EQ(choice.stage, ShadingStage::fragment);
  EXPECT_NEAR(choice.spread_ms, 2, 1e-9);
}

TEST(ChooseShadingStage, ForgivesOneTurnThatWasDisturbedEachWay) {
  FakeDevice device;
  device.pass_ms = [](ShadingStage stage, int i) {
    if (i == 4) return 100.0;
    if (i == 6) return 0.1;
    return stage == ShadingStage::compute ? 5.0 : 6.0;
  };
  EXPECT_EQ(device.choose().stage, ShadingStage::compute);
}

TEST(ChooseShadingStage, AClockThatStandsStillChoosesTheFragmentStage) {
  FakeDevice device;
  device.pass_ms = [](ShadingStage, int) { return 0.0; };
  EXPECT_EQ(device.choose().stage, ShadingStage::fragment);
  EXPECT_LE(device.counts[0], 2 + 7 * 32);
}

}  // namespace
}  // namespace tureen::test
