// The image at rest: its samples are those of supersampling 8, drawn in 64 frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <tuple>

#include "runtime/passes/accumulation.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace at_rest_test {

constexpr int largest_supersampling = 8;

TEST(PositionsAtRest, AreARegularGrid) {
  for (int n = 1; n < largest_supersampling; ++n) {
    const int frames = frames_at_rest(n), side = int(std::lround(std::sqrt(frames)));
    EXPECT_GE(side * n, largest_supersampling) << n;
    std::set<std::pair<int, int>> places;
    for (int i = 0; i < frames; ++i) {
      // From the centre of the sample, whose side is 1 / n.
      const glm::dvec2 cell = (position_at_rest(i, n) * double(n) + 0.5) * double(side) - 0.5;
      EXPECT_NEAR(cell.x, std::round(cell.x), 1e-12);
      EXPECT_NEAR(cell.y, std::round(cell.y), 1e-12);
      const std::pair<int, int> place(std::lround(cell.x), std::lround(cell.y));
      EXPECT_GE(std::min(place.first, place.second), 0);
      EXPECT_LT(std::max(place.first, place.second), side);
      places.insert(place);
    }
    EXPECT_EQ(places.size(), std::size_t(frames)) << n;
  }
  EXPECT_EQ(frames_at_rest(1), 64);
  EXPECT_EQ(frames_at_rest(largest_supersampling), 0);
}

TEST(PositionsAtRest, FourInARowAreBalanced) {
  for (int n = 1; n < largest_supersampling; ++n)
    for (int i = 0; i < frames_at_rest(n); i += 4) {
      glm::dvec2 sum(0.0);
      for (int j = 0; j < 4; ++j) sum += position_at_rest(i + j, n);
      EXPECT_EQ(sum, glm::dvec2(0.0)) << n << ", frame " << i;
    }
}

Renderer renderer_of_scene(const gl::Context& context, const Scene& scene,
                           const Quality& quality = {}, float background_alpha = 1,
                           SplatBlending blending = SplatBlending::automatic) {
  const RenderOptions options{.plan = {.quality = quality, .splat_blending = blending},
                              .background = glm::vec4(0.9f, 0.2f, 0.5f, background_alpha)};
  return Renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                  options);
}

/// PSNR in dB of visible colours, and of alpha.
double psnr(const Image8& a, const Image8& b) {
  const auto visible = [](glm::u8vec4 pixel) {
    const glm::dvec4 value = glm::dvec4(pixel) / 255.0;
    return glm::dvec4(glm::dvec3(value) * value.a, value.a);
  };
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::dvec4 difference = visible(a.pixels[i]) - visible(b.pixels[i]);
    sum += glm::dot(difference, difference);
  }
  return -10 * std::log10(std::max(sum / (4 * double(a.pixels.size())), 1e-10));
}

/// docs/viewer.md and docs/web.md give this for the image at rest.
constexpr double min_psnr = 60;

/// The image at rest of one renderer against the frame of another with 8 x 8 samples per pixel.
void expect_as_supersampled(const gl::Context& context, const Scene& scene, const Camera& camera,
                            float background_alpha = 1, Quality quality = {},
                            SplatBlending blending = SplatBlending::automatic) {
  Renderer plain = renderer_of_scene(context, scene, quality, background_alpha, blending);
  plain.draw({camera});
  const Image8 frame = plain.read_color();
  plain.draw_at_rest({camera});
  quality.supersampling = largest_supersampling;
  Renderer reference = renderer_of_scene(context, scene, quality, background_alpha, blending);
  reference.draw({camera});
  const Image8 expected = reference.read_color();
  EXPECT_GE(psnr(plain.read_color(), expected), min_psnr);
  EXPECT_LT(psnr(frame, expected), 50) << "the image must have edges";
}

Camera camera_of_soups(int width, int height) {
  Random random(31);
  return random_camera(random, width, height);
}

/// Cut-outs, in two layers that cross each other.
Scene two_soups() {
  Scene scene;
  for (const std::uint64_t seed : {31, 32})
    scene.layers.push_back(
        {.name = std::to_string(seed),
         .primitives =
             random_soup(seed, {.kind = Kind::lattice_mlp, .faces = 80, .size = 0.3, .level = 2})});
  scene.layers[1].world_from_layer = glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0.1, 0.0));
  return scene;
}

class AtRest : public testing::TestWithParam<NamedContext> {
 protected:
  gl::Context context = gl::Context::create(GetParam().request);
};

TEST_P(AtRest, ASoupWithCutOuts) {
  for (const Kind kind : {Kind::lattice, Kind::uv_textures, Kind::face_colors})
    for (const float alpha : {1.0f, 0.0f}) {
      SCOPED_TRACE(to_string(kind) + (alpha > 0 ? "" : ", transparent background"));
      const Scene scene = scene_of(random_soup(33, {.kind = kind, .faces = 80, .size = 0.3}));
      expect_as_supersampled(context, scene, camera_of_soups(121, 83), alpha);
    }
}

TEST_P(AtRest, SeveralLayers) {
  expect_as_supersampled(context, two_soups(), camera_of_soups(121, 83));
  Scene hidden = two_soups();
  hidden.layers[0].visible = false;
  expect_as_supersampled(context, hidden, camera_of_soups(121, 83));
}

TEST_P(AtRest, SamplesOfThePlanCount) {
  for (const int n : {2, 4}) {
    SCOPED_TRACE(n);
    Renderer renderer = renderer_of_scene(context, two_soups(), {.supersampling = n});
    renderer.draw({camera_of_soups(61, 43)});
    int frames = 0;
    for (; renderer.can_refine(); ++frames) renderer.refine();
    EXPECT_EQ(frames * n * n, 64);
    expect_as_supersampled(context, two_soups(), camera_of_soups(61, 43), 1, {.supersampling = n});
  }
}

TEST_P(AtRest, EndsAfter64FramesAndShowsOnlyBalancedMeans) {
  Renderer renderer = renderer_of_scene(context, two_soups());
  const FrameInput input{camera_of_soups(61, 43)};
  EXPECT_FALSE(renderer.shows(input));
  EXPECT_FALSE(renderer.can_refine());
  renderer.draw(input);
  EXPECT_TRUE(renderer.shows(input));
  Image8 before = renderer.read_color();
  const Image8 frame = before;
  const std::size_t bytes = renderer.target_bytes();
  int frames = 0;
  while (renderer.can_refine()) {
    renderer.refine();
    ++frames;
    const Image8 now = renderer.read_color();
    if (frames % 4 != 0)
      EXPECT_EQ(now.pixels, before.pixels) << frames;
    else
      EXPECT_NE(now.pixels, before.pixels) << frames;
    before = now;
    EXPECT_TRUE(renderer.shows(input));
  }
  EXPECT_EQ(frames, 64);
  // The image remains, of 8 bits; the sums are gone.
  EXPECT_EQ(renderer.target_bytes(), bytes + 4 * 61 * 43);
  renderer.draw(input);
  EXPECT_EQ(renderer.read_color().pixels, frame.pixels) << "a new beginning";
  renderer.draw_at_rest(input);
  EXPECT_EQ(renderer.read_color().pixels, before.pixels) << "the same again";
}

TEST_P(AtRest, AnyChangeEndsIt) {
  Scene scene = two_soups();
  scene.layers.push_back({.primitives = random_splats(splat_kinds[0], 20, 0.1, 3)});
  Renderer renderer = renderer_of_scene(context, scene);
  const FrameInput input{camera_of_soups(61, 43)};
  const std::function<void()> changes[] = {
      [&] { renderer.set_background(glm::vec4(0, 0, 1, 1)); },
      [&] { renderer.place_layer(1, glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, 0, 0))); },
      [&] { renderer.show_layer(0, false); },
      [&] { renderer.swap_layers(0, 1); },
      [&] {
        renderer.add_layers(prepare_scene(two_soups(), device_limits(context.capabilities())));
      },
      [&] { renderer.remove_layer(0); },
      [&] { renderer.leave_context(); },
  };
  for (const auto& change : changes) {
    renderer.draw(input);
    ASSERT_TRUE(renderer.can_refine());
    for (int i = 0; i < 5; ++i) renderer.refine();
    change();
    EXPECT_FALSE(renderer.shows(input));
    EXPECT_FALSE(renderer.can_refine());
  }
  renderer.draw(input);
  FrameInput other = input;
  other.camera.cx += 1;
  EXPECT_FALSE(renderer.shows(other));
  // Another size, in between.
  other.camera = camera_of_soups(50, 70);
  renderer.draw_at_rest(other);
  EXPECT_EQ(renderer.read_color().width, 50);
}

TEST_P(AtRest, NotWithAResolutionScaleOrPassesFromOutside) {
  const FrameInput input{camera_of_soups(61, 43)};
  Renderer scaled = renderer_of_scene(context, two_soups(), {.resolution_scale = 0.5});
  scaled.draw(input);
  EXPECT_FALSE(scaled.can_refine());
  Renderer full = renderer_of_scene(context, two_soups(), {.supersampling = 8});
  full.draw(input);
  EXPECT_FALSE(full.can_refine());
  Renderer other = renderer_of_scene(context, two_soups());
  other.set_passes({});
  other.draw(input);
  EXPECT_FALSE(other.can_refine());
}

// SplatsAtRest, below, accumulates in all contexts.
INSTANTIATE_TEST_SUITE_P(Context, AtRest, in_osmesa(), context_name);
INSTANTIATE_TEST_SUITE_P(Thorough, AtRest, in_the_others(), context_name);

// -- splats ---------------------------------------------------------------------------------------

SplatKind kind_of(std::string_view name) {
  return *std::find_if(std::begin(splat_kinds), std::end(splat_kinds),
                       [&](const SplatKind& kind) { return kind.name == name; });
}

struct NamedBlending {
  const char* name;  // of a test parameter
  SplatBlending blending;
};
constexpr NamedBlending blendings[] = {{"raster", SplatBlending::raster},
                                       {"tiles", SplatBlending::tiles}};

class SplatsAtRest : public testing::TestWithParam<InContext<NamedBlending>> {
 protected:
  gl::Context context = gl::Context::create(std::get<0>(GetParam()).request);
  SplatBlending blending = std::get<1>(GetParam()).blending;
};

// Profiles without a low pass: alone, the image at rest smooths their edges.
TEST_P(SplatsAtRest, WithoutALowPassAreSmoothed) {
  for (const char* name : {"windows", "neural", "discs_redisplats"}) {
    SCOPED_TRACE(name);
    const Scene scene = scene_of(random_splats(kind_of(name), 200, 0.1, 2));
    expect_as_supersampled(context, scene, camera_of_ball(2.5, 121, 83), 1, {}, blending);
    expect_as_supersampled(context, scene, camera_of_ball(2.5, 61, 43), 0, {}, blending);
  }
}

// With a low pass, one sample per pixel is the method's own image.
TEST_P(SplatsAtRest, WithALowPassAreShownAsTheyAre) {
  for (const char* name : {"gaussians_3dgs", "gaussians_mip", "discs_2dgs"}) {
    SCOPED_TRACE(name);
    Scene scene = scene_of(random_splats(kind_of(name), 200, 0.1, 2));
    const Camera camera = camera_of_ball(2.5, 121, 83);
    Renderer alone = renderer_of_scene(context, scene, {}, 1, blending);
    alone.draw({camera});
    EXPECT_TRUE(alone.shows({camera}));
    EXPECT_FALSE(alone.can_refine());
    // Beside a soup, whose edges need it, all are averaged.
    scene.layers.push_back({.primitives = random_soup(34, {.faces = 40, .size = 0.4})});
    expect_as_supersampled(context, scene, camera, 1, {}, blending);
    scene.layers.back().visible = false;
    Renderer hidden = renderer_of_scene(context, scene, {}, 1, blending);
    EXPECT_FALSE(hidden.has_image_at_rest());
  }
}

INSTANTIATE_TEST_SUITE_P(, SplatsAtRest, in_contexts(blendings), name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, SplatsAtRest, in_other_contexts(blendings), name_in_context);

// The reason of has_image_at_rest(). The true value of a pixel is the mean over its area of splats
// without a low pass. Mip's low pass, made for one sample per pixel, comes nearer to it than the
// mean of its 64 samples, which filters twice: 40.9 dB against 39.4 dB.
TEST(LowPass, OfMipReplacesTheMean) {
  const gl::Context context = gl::Context::create(osmesa);
  // Standard deviations of about half a pixel.
  Scene scene = scene_of(random_splats(kind_of("gaussians_mip"), 3000, 0.005, 2));
  const Camera camera = camera_of_ball(2.5, 160, 120);
  const auto image = [&](int supersampling) {
    Renderer renderer = renderer_of_scene(context, scene, {.supersampling = supersampling});
    renderer.draw({camera});
    return renderer.read_color();
  };
  const Image8 once = image(1), mean = image(8);
  std::get<Splats>(scene.layers[0].primitives).profile.low_pass = SplatProfile::LowPass::none;
  const Image8 truth = image(8);
  EXPECT_GT(psnr(once, truth), psnr(mean, truth));
}

// Frames at rest have different random numbers, so the noise of stochastic splats goes down by 64,
// 18 dB.
TEST(StochasticSplats, AtRestAreTheBlendedImage) {
  const gl::Context context = gl::Context::create(osmesa);
  const Scene scene = scene_of(random_splats(kind_of("gaussians_3dgs"), 300, 0.2, 2));
  const Camera camera = camera_of_ball(2.5, 121, 83);
  Renderer blended =
      renderer_of_scene(context, scene, {.supersampling = 8}, 1, SplatBlending::raster);
  blended.draw({camera});
  const Image8 expected = blended.read_color();
  Renderer renderer =
      renderer_of_scene(context, scene, {.splat_order = Quality::SplatOrder::stochastic});
  renderer.draw({camera});
  const double noisy = psnr(renderer.read_color(), expected);
  renderer.draw_at_rest({camera});
  EXPECT_NEAR(psnr(renderer.read_color(), expected) - noisy, 18, 2);
}

}  // namespace at_rest_test
}  // namespace tureen::test
