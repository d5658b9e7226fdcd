// Plans with quality settings; their frames must not affect the next frame.
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "runtime/gl/api.hpp"
#include "tests/runtime/quality_drawing.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {
namespace quality_test {

// -- the plan -------------------------------------------------------------------------------------

TEST(QualityPlan, IsWhatWasAskedFor) {
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  for (const Quality& quality :
       {Quality{}, Quality{.resolution_scale = 0.5}, Quality{.supersampling = 3}})
    EXPECT_EQ(make_plan(soup, {}, with(quality)).quality, quality);
}

TEST(QualityPlan, WhatCannotBeDrawnIsRefused) {
  EXPECT_THROW(make_plan(soup_of(Kind::lattice_mlp), {}, with({.supersampling = 9})), UsageError);
}

// -- state after a frame -------------------------------------------------------------------------

const std::vector<RenderOptions> every_way = {
    options_with({}),
    {.plan = {.site = ShadingSite::forward}, .limits = {}},
    options_with({.supersampling = 2}),
    options_with({.resolution_scale = 0.5})};

class Frames : public testing::TestWithParam<NamedContext> {};

// Renderers and image sizes alternate; every image must be the same as if drawn alone.
TEST_P(Frames, LeaveNothingForTheNext) {
  const gl::Context context = gl::Context::create(GetParam().request);
  const TriangleSoup soup = soup_of(Kind::lattice_mlp);
  const Camera cameras[] = {camera_of(64, 48), camera_of(37, 61)};
  std::vector<Image8> alone;
  for (const RenderOptions& options : every_way)
    for (const Camera& camera : cameras) alone.push_back(draw(context, soup, camera, options));
  std::vector<Renderer> renderers;
  for (const RenderOptions& options : every_way)
    renderers.push_back(renderer_of(context, soup, glm::dvec3(0), options));
  for (int round = 0; round < 2; ++round)
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < renderers.size(); ++i) {
        renderers[i].draw({cameras[c]});
        const Image8 image = renderers[i].read_color();
        EXPECT_EQ(image.width, cameras[c].width);
        EXPECT_EQ(image.pixels, alone[2 * i + c].pixels) << describe(every_way[i].plan.quality);
      }
}

TEST_P(Frames, DoNotDependOnForeignState) {
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
  for (const RenderOptions& options : every_way) {
    const gl::Context fresh = gl::Context::create(GetParam().request);
    const Image8 expected = draw(fresh, soup, camera, options);
    gl::Context disturbed = gl::Context::create(GetParam().request);
    disturb();
    Renderer renderer = renderer_of(disturbed, soup, {}, options);
    disturb();
    renderer.draw({camera});
    disturb();
    EXPECT_EQ(renderer.read_color().pixels, expected.pixels) << describe(options.plan.quality);
  }
}

TEST_P(Frames, AreCopiedAtFullSize) {
  const gl::Context context = gl::Context::create(GetParam().request);
  const TriangleSoup soup = soup_of(Kind::face_colors);
  Renderer renderer = renderer_of(context, soup, {}, options_with({.resolution_scale = 0.5}));
  renderer.draw({camera_of(40, 30)});
  const Image8 expected = renderer.read_color();
  // A framebuffer of the image's size that does not belong to the renderer.
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

}  // namespace quality_test
}  // namespace tureen::test
