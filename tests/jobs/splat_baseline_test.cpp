// The plain baseline for splats: its plan, its order, and its frames against the oracle's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "base/error.hpp"
#include "image/metrics.hpp"
#include "jobs/baseline/baseline.hpp"
#include "jobs/baseline/splat_baseline_order.hpp"
#include "oracle/oracle.hpp"
#include "runtime/plan/plan_description.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/made_once.hpp"
#include "tests/support/random_splats.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace splat_baseline_test {

using testing::ElementsAre;
using testing::StartsWith;

SplatKind kind_named(std::string_view name) {
  return *std::find_if(std::begin(splat_kinds), std::end(splat_kinds),
                       [&](const SplatKind& kind) { return kind.name == name; });
}

/// Splats with colours between 0 and 1: the baseline clamps each splat's, the oracle only pixels'.
Splats splats_of(const SplatKind& kind) {
  Splats splats = random_splats(kind, 2000, 0.1, 4);
  for (glm::vec3& coefficient : splats.color.coefficients) coefficient *= 0.25f;
  return splats;
}

// -- the plan -------------------------------------------------------------------------------------

TEST(SplatBaselinePlan, DrawsEverySplatWithAllBands) {
  Splats splats = splats_of(kind_named("gaussians_3dgs"));
  std::get<Gaussians>(splats.kernel).opacity[7] = 0;
  std::fill(splats.color.coefficients.begin(), splats.color.coefficients.end(), glm::vec3(0));
  const RenderPlan plan = make_baseline_plan(splats);
  EXPECT_EQ(plan.splats(0).drawn.size(), count(splats));
  EXPECT_EQ(plan.splats(0).harmonics_degree, 2);
  EXPECT_THAT(describe(plan), ElementsAre(StartsWith("baseline: ")));
  EXPECT_THAT(
      describe(make_baseline_plan(
          splats, {.quality = {.supersampling = 2}, .splat_blending = SplatBlending::raster})),
      ElementsAre(StartsWith("baseline: "), "draws " + describe(Quality{.supersampling = 2}),
                  StartsWith("--blend ")));
}

TEST(SplatBaselinePlan, RefusesWhatTheBaselineCannotDraw) {
  for (const char* name : {"discs_2dgs", "discs_redisplats", "neural"}) {
    const Splats splats = splats_of(kind_named(name));
    EXPECT_THAT(error_of<UsageError>([&] { make_baseline_plan(splats); }),
                ErrorAt("", kernel_name(splats.kernel)));
  }
  EXPECT_THAT(
      error_of<UsageError>([] { make_baseline_plan(splats_of(kind_named("windows_per_corner"))); }),
      ErrorAt("", "corner"));
  EXPECT_THROW(make_baseline_plan(splats_of(kind_named("windows")), {.as_published = true}),
               UsageError);
  EXPECT_THROW(
      make_baseline_plan(splats_of(kind_named("windows")), {.quality = {.supersampling = 9}}),
      UsageError);
}

// -- the order ------------------------------------------------------------------------------------

/// A camera at the origin that looks along -z.
FrameCamera looking_down_z() { return {.camera = {}, .eye = {}, .range = {}}; }

TEST(SplatBaselineOrder, IsFromFarToNearInStepsOf16Bits) {
  const Splats splats = splats_of(kind_named("gaussians_3dgs"));
  const std::vector<glm::vec3>& centers = std::get<Gaussians>(splats.kernel).centers;
  SplatBaselineOrder order;
  const std::span<const std::uint32_t> sorted = order.sort(centers, looking_down_z());
  EXPECT_EQ(std::set<std::uint32_t>(sorted.begin(), sorted.end()).size(), centers.size());
  ASSERT_EQ(sorted.size(), centers.size());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    EXPECT_LE(centers[sorted[i - 1]].z, centers[sorted[i]].z + 2.0f / 65535)
        << "the ball is 2 units deep";
}

TEST(SplatBaselineOrder, KeepsTheOrderOfEqualDepthsAndBearsLimits) {
  SplatBaselineOrder order;
  EXPECT_TRUE(order.sort({}, looking_down_z()).empty());
  const std::vector<glm::vec3> equal(3, glm::vec3(1, 2, -3));
  EXPECT_THAT(order.sort(equal, looking_down_z()), ElementsAre(0, 1, 2));
  const std::vector<glm::vec3> limits{{0, 0, 3e38f}, {0, 0, 0}, {0, 0, -3e38f}};
  EXPECT_THAT(order.sort(limits, looking_down_z()), ElementsAre(2, 1, 0));
}

// -- frames ---------------------------------------------------------------------------------------

double psnr_of_splats(const Image8& image, const OracleImage& expected) {
  double sum = 0;
  std::size_t covered = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (expected.splat_alpha[i] == 0) continue;
    ++covered;
    for (int c = 0; c < 3; ++c) {
      const double error = image.pixels[i][c] / 255.0 - double(expected.color.pixels[i][c]);
      sum += error * error / 3;
    }
  }
  EXPECT_GT(double(covered), 0.1 * double(image.pixels.size())) << "too little to compare";
  return psnr_from_mse(sum / double(covered));
}

class SplatBaseline : public testing::TestWithParam<InContext<const char*>> {
 protected:
  gl::Context context = gl::Context::create(std::get<0>(GetParam()).request);
  SplatKind kind = kind_named(std::get<1>(GetParam()));

  /// In dB. Measured before these tests were written: 52.5 for windows, which rounding to 8 bits
  /// after each splat, and 16-bit depths, explain. Gaussians end where alpha is e^-4 of the
  /// opacity, not 1/255: 46.0 to 47.5. A prototype had 52.2 to 52.5, and 40 to 44 on the denser
  /// guitar.
  double min_psnr() const { return kind.kernel == SplatKind::Kernel::windows ? 51 : 45; }
};

// In a layer that is turned, scaled and moved.
TEST_P(SplatBaseline, AgreesWithTheOracle) {
  Scene scene = scene_of(splats_of(kind));
  const glm::dmat4 twice = glm::scale(glm::dmat4(1), glm::dvec3(2));
  const glm::dmat4 place =
      glm::rotate(glm::translate(glm::dmat4(1), {1, -2, 3}), 2.1, {0.6, 0, 0.8}) * twice;
  scene.layers[0].world_from_layer = place;
  Camera camera = camera_of_ball(3, 160, 120);
  camera.view_from_world = twice * camera.view_from_world * glm::inverse(place);
  Renderer renderer = make_renderer(context, scene, PipelineKind::baseline);
  renderer.draw({camera});
  const OracleImage& expected =
      made_once(std::string(kind.name), [&] { return render_oracle(scene, {camera}); });
  const double psnr = psnr_of_splats(renderer.read_color(), expected);
  RecordProperty("psnr_db", std::to_string(psnr));
  EXPECT_GE(psnr, min_psnr());
}

TEST_P(SplatBaseline, SkipsCentersNearTheEye) {
  Splats splats = splats_of(kind);
  splats.profile.min_center_depth = 2.9f;
  const Scene scene = scene_of(splats);
  const Camera camera = camera_of_ball(3, 160, 120);
  Renderer renderer = make_renderer(context, scene, PipelineKind::baseline);
  renderer.draw({camera});
  const OracleImage& expected =
      made_once(std::string(kind.name), [&] { return render_oracle(scene, {camera}); });
  EXPECT_GE(psnr_of_splats(renderer.read_color(), expected), min_psnr());
}

TEST_P(SplatBaseline, DrawsOnATransparentBackground) {
  const Scene scene = scene_of(splats_of(kind));
  const FrameInput input{camera_of_ball(3, 160, 120)};
  Renderer renderer = make_renderer(context, scene, PipelineKind::baseline);
  renderer.draw(input);
  const Image8 on_black = renderer.read_color();
  renderer.set_background(glm::vec4(0));
  renderer.draw(input);
  const Image8 transparent = renderer.read_color();
  bool partly = false;
  for (std::size_t i = 0; i < on_black.pixels.size(); ++i) {
    const glm::u8vec4 &pixel = transparent.pixels[i], &black = on_black.pixels[i];
    partly |= pixel.a > 0 && pixel.a < 255;
    // Colour and alpha are rounded once more each.
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(pixel[c] * pixel.a / 255.0, black[c], 1.01) << "pixel " << i;
  }
  EXPECT_TRUE(partly);
  renderer.set_background(glm::vec4(0, 0, 0, 1));
  renderer.draw(input);
  EXPECT_EQ(renderer.read_color().pixels, on_black.pixels);
}

TEST_P(SplatBaseline, DrawsTheSameAfterItLeftTheContext) {
  Renderer renderer = make_renderer(context, scene_of(splats_of(kind)), PipelineKind::baseline,
                                    {.background = glm::vec4(0)});
  const FrameInput input{camera_of_ball(3, 64, 48)};
  renderer.draw(input);
  const Image8 expected = renderer.read_color();
  renderer.leave_context();
  renderer.draw(input);
  EXPECT_EQ(renderer.read_color().pixels, expected.pixels);
}

TEST_P(SplatBaseline, BearsHostileSplats) {
  Renderer renderer =
      make_renderer(context, scene_of(hostile_splats(kind)), PipelineKind::baseline);
  for (const double distance : {0.05, 3.0}) renderer.draw({camera_of_ball(distance, 64, 48)});
  EXPECT_EQ(renderer.read_color().pixels.size(), 64u * 48u);
}

constexpr const char* baseline_kinds[] = {"windows", "gaussians_3dgs", "gaussians_mip",
                                          "flat_games"};
INSTANTIATE_TEST_SUITE_P(, SplatBaseline, in_contexts(baseline_kinds), name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, SplatBaseline, in_other_contexts(baseline_kinds),
                         name_in_context);

}  // namespace splat_baseline_test
}  // namespace tureen::test
