// Images by rays in steps against TracedImages, which draws them at once.
#include "tracing/progressive_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "tests/tracing/tracing_scenes.hpp"

namespace tureen::test {
namespace progressive_image_test {

using tracing::ProgressiveImage;
using tracing::TracedImages;

constexpr glm::vec3 background(0.2f, 0.4f, 0.6f);
constexpr double unlimited = 1e9;

/// Splats, a soup, a mirror and glass.
Scene mixed_scene() {
  Scene scene;
  scene.layers = {
      layer_of(random_splats(splat_kinds[1], 300, 0.2, 61)),
      layer_of(random_soup(62, {.faces = 20, .size = 0.3})),
      with(layer_of(unit_ball(2), ball_at({0.5, 0.9, -0.4}, 0.4)), mirror_material()),
      with(layer_of(unit_ball(2), ball_at({-0.1, 0.7, -0.9}, 0.4)), glass_material(1.5f))};
  return scene;
}

/// Four tiles.
Camera camera() { return camera_of_ball(3, 200, 140); }

Image8 at_once(const Scene& scene, int samples) {
  Image8 image =
      TracedImages(scene, {.samples = samples, .background = background}).image({camera()});
  for (glm::u8vec4& pixel : image.pixels) pixel.a = 255;
  return image;
}

/// The part of the pixels that differ by more than `steps` of 255.
double part_that_differs(const Image8& a, const Image8& b, int steps) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c)
      if (std::abs(int(a.pixels[i][c]) - int(b.pixels[i][c])) > steps) {
        ++count;
        break;
      }
  return double(count) / double(a.pixels.size());
}

/// Tiles round the places of splats in the image otherwise than whole images, by 2^-24 of a place.
void expect_same(const Image8& actual, const Image8& expected) {
  EXPECT_LE(part_that_differs(actual, expected, 1), 0.001);
  EXPECT_LE(part_that_differs(actual, expected, 0), 0.01);
}

TEST(CoarseSquare, IsTheFinestThatTheTimeAllows) {
  EXPECT_EQ(tracing::coarse_square(1e6, 0, 0.25), 16) << "not measured";
  EXPECT_EQ(tracing::coarse_square(1e6, 2e-7, 0.25), 1);
  EXPECT_EQ(tracing::coarse_square(1e6, 3e-7, 0.25), 2);
  EXPECT_EQ(tracing::coarse_square(1e6, 1.5e-5, 0.25), 8);
  EXPECT_EQ(tracing::coarse_square(1e6, 1, 0.25), 16);
}

TEST(ProgressiveImage, IsCoarseThenSharpFromTheMiddleThenSmooth) {
  const Scene scene = mixed_scene();
  TracedImages images(scene, {.background = background});
  const Image8 sharp = at_once(scene, 1);
  ProgressiveImage image(camera(), 3, unlimited);
  // A slow machine, whatever the steps measure.
  const auto step = [&] {
    double slow = 1;
    image.step(images, slow);
    EXPECT_GT(slow, 0);
    EXPECT_LT(slow, 1);
  };
  step();
  EXPECT_EQ(image.samples(), 0);
  EXPECT_EQ(image.sharp(), 0);
  const Image8 coarse = image.image();
  // Coarse, but of the same view: most pixels are within an eighth of white.
  EXPECT_GE(part_that_differs(coarse, sharp, 1), 0.3);
  EXPECT_LE(part_that_differs(coarse, sharp, 32), 0.5);

  step();
  EXPECT_EQ(image.sharp(), 0.25);
  const std::size_t middle = 200 * 64 + 64, corner = 200 * 139 + 199;
  EXPECT_EQ(image.image().pixels[middle], sharp.pixels[middle]);
  EXPECT_EQ(image.image().pixels[corner], coarse.pixels[corner]);
  for (int tile = 1; tile < 4; ++tile) step();
  EXPECT_EQ(image.samples(), 1);
  expect_same(image.image(), sharp);
  EXPECT_FALSE(image.is_complete());
  step();
  step();
  EXPECT_TRUE(image.is_complete());
  expect_same(image.image(), at_once(scene, 3));
  double fast = 0;
  image.step(images, fast);
  EXPECT_EQ(image.samples(), 3);
}

TEST(ProgressiveImage, IsSharpAtOnceIfThatIsFast) {
  const Scene scene = mixed_scene();
  TracedImages images(scene, {.background = background});
  ProgressiveImage image(camera(), 1, unlimited);
  double fast = 1e-9;
  image.step(images, fast);
  EXPECT_TRUE(image.is_complete());
  EXPECT_EQ(image.image().pixels, at_once(scene, 1).pixels);
}

TEST(ProgressiveImage, GetsNoFurtherSampleAfterItsTime) {
  const Scene scene = mixed_scene();
  TracedImages images(scene, {.background = background});
  ProgressiveImage image(camera(), 1000, 0);
  double fast = 1e-9;
  image.step(images, fast);
  EXPECT_TRUE(image.is_complete());
  EXPECT_EQ(image.samples(), 1);
}

/// Cancelled at each of its calls of progress, then drawn: nothing is lost or counted twice.
TEST(ProgressiveImage, StaysAsItIsWhenCancelled) {
  struct Stop {};
  const Scene scene = mixed_scene();
  // One thread makes all calls.
  TracedImages images(scene, {.background = background, .threads = 1});
  ProgressiveImage image(camera(), 2, unlimited);
  int cancelled = 0;
  while (!image.is_complete()) {
    const Image8 before = image.image();
    int calls = 0, limit = 1 + cancelled % 7;
    images.report_to([&](double) {
      if (++calls == limit) throw Stop();
    });
    double slow = 1;
    EXPECT_THROW(image.step(images, slow), Stop);
    ++cancelled;
    EXPECT_EQ(image.image().pixels, before.pixels);
    images.report_to({});
    slow = 1;
    image.step(images, slow);
  }
  EXPECT_EQ(cancelled, 6);
  expect_same(image.image(), at_once(scene, 2));
}

TEST(TracedImagesSync, FollowsALayerWithoutANewTree) {
  const Scene as_read = mixed_scene();  // the layers refer to its primitives
  Scene scene = as_read;
  TracedImages images({.background = background});
  std::vector<DocumentLayer> layers = tracing::layers_for_rays(as_read);
  images.sync(layers);
  const auto nodes = [&](std::uint32_t layer) {
    return images.scene().layer(layer).bvh().nodes().data();
  };
  const tracing::Node* const before[] = {nodes(0), nodes(2)};
  const auto expect_image = [&](const char* what) {
    EXPECT_EQ(images.image({camera()}).pixels,
              TracedImages(scene, {.background = background}).image({camera()}).pixels)
        << what;
  };
  expect_image("as stored");
  const Image8 stored = images.image({camera()});
  for (const std::size_t i : {0u, 2u})
    scene.layers[i].world_from_layer = layers[i].world_from_layer =
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.3, -0.2, 0.1)) *
        scene.layers[i].world_from_layer;
  images.sync(layers);
  expect_image("moved");
  EXPECT_NE(images.image({camera()}).pixels, stored.pixels);
  scene.layers[0].visible = layers[0].visible = false;
  scene.layers[3].material = layers[3].material = std::nullopt;
  images.sync(layers);
  expect_image("hidden, and another surface");
  scene.layers[0].visible = layers[0].visible = true;
  std::swap(scene.layers[1], scene.layers[2]);
  std::swap(layers[1], layers[2]);
  images.sync(layers);
  expect_image("shown, in another order");
  EXPECT_EQ(nodes(0), before[0]);
  EXPECT_EQ(nodes(1), before[1]);
  layers.erase(layers.begin());
  scene.layers.erase(scene.layers.begin());
  images.sync(layers);
  expect_image("removed");
}

TEST(TracedImagesSync, MayBeCancelledAndThenGoesOn) {
  struct Stop {};
  const Scene scene = mixed_scene();
  const std::vector<DocumentLayer> layers = tracing::layers_for_rays(scene);
  // One thread makes all calls.
  TracedImages images({.background = background, .threads = 1});
  int calls = 0;
  images.report_to([&](double) { ++calls; });
  images.sync(layers);
  images.report_to({});
  ASSERT_GE(calls, 5);
  for (int last = 1; last <= calls; ++last) {
    TracedImages cancelled({.background = background, .threads = 1});
    cancelled.report_to([left = last](double) mutable {
      if (--left == 0) throw Stop();
    });
    EXPECT_THROW(cancelled.sync(layers), Stop);
    cancelled.report_to({});
    cancelled.sync(layers);
    EXPECT_EQ(cancelled.image({camera()}).pixels, images.image({camera()}).pixels) << last;
  }
}

}  // namespace progressive_image_test
}  // namespace tureen::test
