// What plans make of a preset's drawing knobs: what is planned, refused and said; and that frames
// drawn with them leave nothing behind for the next.
#include "runtime/drawing_knobs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/gl/api.hpp"
#include "runtime/knob_drawing.hpp"
#include "soup/error.hpp"
#include "support/contexts.hpp"

namespace tureen::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;
using FeatureStorage = RenderPreset::FeatureStorage;

// -- the plan -------------------------------------------------------------------------------------

TEST(DrawingKnobs, AFaithfulPresetPlansAsNone) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  EXPECT_EQ(make_plan(soup, {}, with({})).sentences, make_plan(soup, {}).sentences);
}

TEST(DrawingKnobs, EachHasItsSentence) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const RenderPreset presets[] = {{.feature_storage = FeatureStorage::rgba16f},
                                  {.feature_storage = FeatureStorage::rgba8},
                                  {.site = RenderPreset::Site::deferred},
                                  {.site = RenderPreset::Site::forward},
                                  {.resolution_scale = 0.5},
                                  {.supersampling = 3},
                                  {.alpha_to_coverage = 4}};
  for (const RenderPreset& preset : presets)
    EXPECT_THAT(make_plan(soup, {}, with(preset)).sentences, Contains(StartsWith("knob: ")))
        << describe(preset);
}

TEST(DrawingKnobs, FeaturesAreStoredOnlyForANetwork) {
  const RenderPreset preset{.feature_storage = FeatureStorage::rgba8};
  for (const Kind kind : all_kinds) {
    const RenderPlan plan = make_plan(soup_of(kind), {}, with(preset));
    const bool network = kind == Kind::lattice_mlp || kind == Kind::uv_textures_mlp;
    EXPECT_EQ(plan.feature_storage == FeatureStorage::rgba8, network) << to_string(kind);
    EXPECT_EQ(plan.color_mlp, network);
    if (network) {
      EXPECT_TRUE(plan.depth_rejects_background);
    } else {
      EXPECT_THAT(plan.sentences, Contains(HasSubstr("no network that reads them")));
    }
  }
}

TEST(DrawingKnobs, WithoutHalfFloatTargetsTheVisibilityBufferStandsIn) {
  const RenderPlan plan =
      make_plan(soup_of(Kind::lattice_mlp), {.half_float_targets = false, .sample_counts = {4}},
                with({.feature_storage = FeatureStorage::rgba16f}));
  EXPECT_EQ(plan.feature_storage, FeatureStorage::visibility);
  EXPECT_THAT(plan.sentences, Contains(HasSubstr("cannot draw half floats")));
}

TEST(DrawingKnobs, CoverageTakesTheSamplesThatTheDeviceHas) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const auto samples = [&](std::vector<int> counts, int asked) {
    const RenderPlan plan =
        make_plan(soup, {.sample_counts = std::move(counts)}, with({.alpha_to_coverage = asked}));
    EXPECT_EQ(plan.site, ShadingSite::forward);
    EXPECT_THAT(plan.sentences,
                Contains(HasSubstr(plan.coverage_samples == asked
                                       ? "of " + std::to_string(asked) + " samples"
                                       : std::to_string(asked) + " were asked for")));
    return plan.coverage_samples;
  };
  EXPECT_EQ(samples({2, 4, 8}, 2), 2);
  EXPECT_EQ(samples({2, 4, 8}, 8), 8);
  EXPECT_EQ(samples({4}, 2), 4);
  EXPECT_EQ(samples({2, 4}, 8), 4);
  EXPECT_THROW(make_plan(soup, {.sample_counts = {}}, with({.alpha_to_coverage = 2})),
               DeviceLimitError);
}

TEST(DrawingKnobs, WhatExcludesEachOtherIsRefused) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const auto refused = [&](const PlanPreferences& plan) {
    try {
      make_plan(soup, {}, plan);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was refused");
  };
  PlanPreferences plan = with({.alpha_to_coverage = 4});
  plan.site = ShadingSite::deferred;
  EXPECT_THAT(refused(plan), HasSubstr("there is no shading pass"));
  plan = with({.feature_storage = FeatureStorage::rgba8});
  plan.site = ShadingSite::forward;
  EXPECT_THAT(refused(plan), HasSubstr("a forward plan has none"));
  for (const RenderPreset& preset :
       {RenderPreset{.feature_storage = FeatureStorage::rgba8},
        RenderPreset{.site = RenderPreset::Site::forward}, RenderPreset{.alpha_to_coverage = 4}}) {
    plan = with(preset);
    plan.pipeline = PipelineKind::published;
    TriangleSoup one_level = random_soup(21, {.kind = Kind::lattice_mlp, .level = 1});
    EXPECT_THROW(make_plan(one_level, {}, plan), UsageError) << describe(preset);
  }
}

// -- what frames leave behind
// -----------------------------------------------------------------------

const RenderPreset every_preset[] = {
    {},
    {.alpha_to_coverage = 4},
    {.feature_storage = FeatureStorage::rgba8},
    {.supersampling = 2},
    {.resolution_scale = 0.5, .alpha_to_coverage = 4},
    {.feature_storage = FeatureStorage::rgba16f, .supersampling = 2}};

class Frames : public testing::TestWithParam<NamedContext> {};

// Renderers in turns, in sizes in turns: every picture as if it were the only one.
TEST_P(Frames, LeaveNothingForTheNext) {
  const gl::Context context = gl::Context::create(GetParam().request);
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const Camera cameras[] = {camera_of(64, 48), camera_of(37, 61)};
  std::vector<Image8> alone;
  for (const RenderPreset& preset : every_preset)
    for (const Camera& camera : cameras)
      alone.push_back(draw(context, soup, camera, options_with(preset)));
  std::vector<Renderer> renderers;
  for (const RenderPreset& preset : every_preset)
    renderers.emplace_back(context, soup, glm::dvec3(0), options_with(preset));
  for (int round = 0; round < 2; ++round)
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < renderers.size(); ++i) {
        renderers[i].draw(cameras[c]);
        const Image8 image = renderers[i].read_color();
        EXPECT_EQ(image.width, cameras[c].width);
        EXPECT_EQ(image.pixels, alone[2 * i + c].pixels) << describe(every_preset[i]);
      }
}

TEST_P(Frames, DoNotDependOnStateThatSomebodyElseLeft) {
  const gl::Context context = gl::Context::create(GetParam().request);
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const Camera camera = camera_of(64, 48);
  const auto disturb = [&] {
    for (const GLenum capability :
         {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_RASTERIZER_DISCARD,
          GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_POLYGON_OFFSET_FILL})
      glEnable(capability);
    if (context.capabilities().api == gl::Api::desktop) {
      glDisable(GL_MULTISAMPLE);
      glEnable(GL_SAMPLE_ALPHA_TO_ONE);
      glEnable(GL_SAMPLE_MASK);
      glSampleMaski(0, 1);
    }
    glSampleCoverage(0.3f, GL_FALSE);
    glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
    glScissor(0, 0, 1, 1);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
    glDepthMask(GL_FALSE);
  };
  for (const RenderPreset& preset : every_preset) {
    const gl::Context fresh = gl::Context::create(GetParam().request);
    const Image8 expected = draw(fresh, soup, camera, options_with(preset));
    gl::Context disturbed = gl::Context::create(GetParam().request);
    disturb();
    Renderer renderer(disturbed, soup, {}, options_with(preset));
    disturb();
    renderer.draw(camera);
    disturb();
    EXPECT_EQ(renderer.read_color().pixels, expected.pixels) << describe(preset);
  }
}

TEST_P(Frames, AreCopiedAtFullSize) {
  const gl::Context context = gl::Context::create(GetParam().request);
  const TriangleSoup soup = soup_of(Kind::face_colors);
  Renderer renderer(context, soup, {}, options_with({.resolution_scale = 0.5}));
  renderer.draw(camera_of(40, 30));
  const Image8 expected = renderer.read_color();
  // Somebody else's framebuffer of the picture's size.
  GLuint texture, framebuffer;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 40, 30, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  renderer.blit_to(framebuffer);
  Image8 copied(40, 30);
  glReadPixels(0, 0, 40, 30, GL_RGBA, GL_UNSIGNED_BYTE, copied.pixels.data());
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) ASSERT_EQ(copied.at(x, 29 - y), expected.at(x, y));
}

INSTANTIATE_TEST_SUITE_P(Everywhere, Frames, testing::ValuesIn(every_context),
                         [](const auto& i) { return i.param.name; });

}  // namespace
}  // namespace tureen::test
