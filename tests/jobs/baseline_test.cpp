// The baseline: its plan and description, what it rejects, and its frames.
#include "jobs/baseline/baseline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.hpp"
#include "runtime/plan/plan_description.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {
namespace baseline_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::StartsWith;

TriangleSoup one_level() { return random_soup(21, {.kind = Kind::lattice_mlp, .level = 2}); }

// -- the plan -------------------------------------------------------------------------------------

TEST(BaselinePlan, HasTheQualityThatWasAskedFor) {
  const Quality quality{.supersampling = 2};
  EXPECT_EQ(make_baseline_plan(one_level(), {.quality = quality}).quality, quality);
  EXPECT_THROW(make_baseline_plan(one_level(), {.quality = {.supersampling = 9}}), UsageError);
}

TEST(BaselinePlan, IsDescribedAsTheBaseline) {
  PlanPreferences preferences;
  EXPECT_THAT(describe(make_baseline_plan(one_level(), preferences)),
              ElementsAre(StartsWith("baseline: ")));
  preferences.quality.supersampling = 2;
  preferences.specialisations = SpecialisationSet::all().without(Specialisation::alpha_test);
  EXPECT_THAT(describe(make_baseline_plan(one_level(), preferences)),
              ElementsAre(StartsWith("baseline: "), "draws " + describe(preferences.quality),
                          AllOf(StartsWith("--keep "), Names("baseline"))));
}

TEST(BaselinePlan, RefusesWhatTheBaselineCannotDraw) {
  const TriangleSoup colors = random_soup(1, {.kind = Kind::face_colors});
  EXPECT_THAT(error_of<UsageError>([&] { make_baseline_plan(colors); }),
              ErrorAt("", appearance_name(colors.appearance)));
  EXPECT_THROW(make_baseline_plan(random_soup(1, {.kind = Kind::lattice, .level = 2})), UsageError)
      << "without a color MLP";
  EXPECT_THROW(make_baseline_plan(random_soup(1, {.kind = Kind::lattice_mlp})), UsageError)
      << "of several lattice levels";
  EXPECT_THROW(make_baseline_plan(one_level(), {.shading_stage = ShadingStage::compute}),
               UsageError);
}

// -- frames ---------------------------------------------------------------------------------------

class BaselineOracle : public testing::TestWithParam<int> {};

// Features are quantised to 8 bits once more than the texels, before the network.
TEST_P(BaselineOracle, AgreesAtThisLevel) {
  gl::Context context = gl::Context::create({});
  const std::uint64_t seed = 200 + std::uint64_t(GetParam());
  const TriangleSoup soup = random_soup(seed, {.kind = Kind::lattice_mlp, .level = GetParam()});
  Random random(seed);
  const Camera camera = random_camera(random, 320, 240);
  Drawn baseline = draw_baseline(context, soup, {}, camera);
  // It has no face buffer; its rasterisation is the generic plan's with ordinary depth.
  baseline.faces =
      draw(context, soup, {}, camera,
           {.specialise = false, .reversed_depth = false, .site = ShadingSite::deferred})
          .faces;
  // Measured before this test was written: 54 to 61 dB for rounded texels with an 8-bit G-buffer.
  expect_agreement(snapped_oracle(soup, {}, camera), baseline, "baseline", {.min_psnr = 53.0});
}

INSTANTIATE_TEST_SUITE_P(Level, BaselineOracle, testing::Range(0, 8),
                         testing::PrintToStringParamName());

// A layer that turns together with the camera gives the same image.
TEST(Baseline, DrawsALayerInItsPlace) {
  const gl::Context context = gl::Context::create(osmesa);
  Random random(12);
  const Camera camera = random_camera(random, 160, 120);
  const glm::dmat4 turn = glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(3, -4, 5)), 2.1,
                                      glm::dvec3(0.6, 0, 0.8));
  Camera turned = camera;
  turned.view_from_world = camera.view_from_world * glm::inverse(turn);
  Image8 images[2];
  for (const bool is_turned : {false, true}) {
    Scene scene = scene_of(one_level());
    if (is_turned) scene.layers[0].world_from_layer = turn;
    Renderer renderer = make_renderer(context, scene, PipelineKind::baseline);
    renderer.draw({is_turned ? turned : camera});
    images[is_turned] = renderer.read_color();
  }
  std::size_t off = 0;
  for (std::size_t i = 0; i < images[0].pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      off += std::abs(int(images[0].pixels[i][c]) - int(images[1].pixels[i][c])) > 1;
  // The camera's matrix is rounded once more: some vertices move to another 1/256 of a pixel.
  EXPECT_LE(double(off), 0.01 * double(images[0].pixels.size()));
}

TEST(Baseline, DrawsTheSameAfterItLeftTheContext) {
  const gl::Context context = gl::Context::create(osmesa);
  Random random(11);
  const Camera camera = random_camera(random, 64, 48);
  Renderer renderer = make_renderer(context, one_level(), {}, PipelineKind::baseline);
  renderer.draw({camera});
  const Image8 expected = renderer.read_color();
  renderer.leave_context();
  renderer.draw({camera});
  EXPECT_EQ(renderer.read_color().pixels, expected.pixels);
}

TEST(Baseline, TellsWhatItsTargetsTake) {
  const gl::Context context = gl::Context::create(osmesa);
  Renderer renderer = make_renderer(context, one_level(), {}, PipelineKind::baseline);
  EXPECT_EQ(renderer.target_bytes(), 0u) << "no frame yet";
  renderer.draw({look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 160, 120)});
  // A pixel has 4 bytes of depth, of each of two feature targets, and of colour.
  EXPECT_EQ(renderer.target_bytes(), (4 + 3 * 4) * 160u * 120u);
}

TEST(Baseline, HasPointsButNoFacesToRead) {
  const gl::Context context = gl::Context::create(osmesa);
  Renderer renderer = make_renderer(context, one_level(), {}, PipelineKind::baseline);
  renderer.draw({look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 160, 120)});
  EXPECT_TRUE(faces_of(renderer).empty());
  EXPECT_NE(renderer.point_at({80, 60}), std::nullopt);
}

TEST(Baseline, RefusesADeviceWithSmallTextures) {
  const gl::Context context = gl::Context::create(osmesa);
  const RenderOptions options{.limits = DeviceLimits{.max_texture_size = 1024}};
  EXPECT_THAT(error_of<DeviceLimitError>([&] {
                make_renderer(context, one_level(), {}, PipelineKind::baseline, options);
              }),
              Names(1024));
}

}  // namespace baseline_test
}  // namespace tureen::test
