// The tile renderer against the oracle.
#include "splatting/tiles/tile_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <thread>

#include "oracle/oracle.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace tile_renderer_test {

void in_order(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

void in_threads(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::thread other([&] {
    for (std::size_t i = 1; i < count; i += 2) body(i);
  });
  for (std::size_t i = 0; i < count; i += 2) body(i);
  other.join();
}

std::unique_ptr<splatting::Layer> layer_of(const Splats& splats) {
  std::vector<std::uint32_t> all(count(splats));
  std::iota(all.begin(), all.end(), 0u);
  return splatting::make_layer(
      splatting::layer_data(splats, splats.profile, all, splats.color.degree));
}

/// RGBA of the splats of a scene whose layers lie at the origin.
std::vector<float> drawn(const Scene& scene, const Camera& camera,
                         const splatting::Parallel& parallel = in_order,
                         std::span<const float> depths = {},
                         splatting::BlendOrder order = splatting::BlendOrder::centers) {
  std::vector<std::unique_ptr<splatting::Layer>> layers;
  std::vector<splatting::LayerInView> views;
  for (const Layer& layer : scene.layers) {
    const auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats) continue;
    layers.push_back(layer_of(*splats));
    views.push_back({layers.back().get(),
                     splatting::image_view(camera, camera.eye(), 1e-6, splats->profile, camera),
                     1.0});
  }
  // Every value is written: NaN would be no PSNR and no equal value.
  std::vector<float> rgba(4 * std::size_t(camera.width) * std::size_t(camera.height), NAN);
  std::atomic<std::size_t> values = 0;
  splatting::TileRenderer(parallel).draw(
      views, depths,
      [&](int first_row, std::span<const float> rows) {
        std::copy(rows.begin(), rows.end(),
                  rgba.begin() + 4 * std::ptrdiff_t(first_row) * camera.width);
        values += rows.size();
      },
      order);
  EXPECT_EQ(values, rgba.size()) << "each row is given once";
  return rgba;
}

/// PSNR of the colours over black, over the pixels with splats, in dB.
double psnr(const std::vector<float>& rgba, const OracleImage& expected) {
  double sum = 0;
  std::size_t channels = 0;
  for (std::size_t i = 0; i < expected.splat_alpha.size(); ++i) {
    if (expected.splat_alpha[i] == 0 || expected.face[i] != no_face) continue;
    for (std::size_t channel = 0; channel < 3; ++channel, ++channels) {
      const double value = std::clamp(double(rgba[4 * i + channel]), 0.0, 1.0);
      sum += std::pow(value - double(expected.color.pixels[i][int(channel)]), 2);
    }
  }
  EXPECT_GT(channels, expected.splat_alpha.size() / 2) << "too little to compare";
  return -10 * std::log10(std::max(sum / double(channels), 1e-20));
}

Scene over_black(Scene scene) {
  scene.info.background = glm::vec3(0.0f);
  return scene;
}

class TilesOfKind : public testing::TestWithParam<SplatKind> {};

/// With the authors' rule that ends a pixel, which the tiles follow as the oracle does: a pixel
/// that ends at another splat because of a rounding is what limits the agreement.
TEST_P(TilesOfKind, AgreeWithTheOracle) {
  const Scene scene = over_black(scene_of(random_splats(GetParam(), 20000, 0.07, 1)));
  for (const double distance : {3.0, 0.7, 0.1}) {
    // Sizes that are no multiples of a tile.
    const Camera camera = camera_of_ball(distance, 123, 93);
    EXPECT_GE(psnr(drawn(scene, camera), render_oracle(scene, {camera}, {})), 75) << distance;
  }
}

/// Near the middle of the ball, where the eye's plane cuts a tenth of the splats.
TEST_P(TilesOfKind, WithCentersAnywhereAgreeWithTheOracle) {
  Scene scene = over_black(scene_of(random_splats(GetParam(), 20000, 0.07, 1)));
  std::get<Splats>(scene.layers[0].primitives).profile.min_center_depth = 0;
  const Camera camera = camera_of_ball(0.1, 123, 93);
  EXPECT_GE(psnr(drawn(scene, camera), render_oracle(scene, {camera}, {})), 75);
}

class TilesInExactOrder : public testing::TestWithParam<SplatKind> {};

/// In the order along the rays. Two splats whose depths at a pixel differ by less than a rounding
/// may change places: the limit is that of the exact order in 8 bits, 55 dB, and 10 dB more.
TEST_P(TilesInExactOrder, AgreeWithTheOracle) {
  Scene scene = over_black(scene_of(random_splats(GetParam(), 5000, 0.12, 1)));
  scene.layers.push_back({.primitives = random_splats(splat_kinds[1], 2000, 0.1, 4)});
  for (const double distance : {3.0, 0.7}) {
    const Camera camera = camera_of_ball(distance, 123, 93);
    const OracleImage expected =
        render_oracle(scene, {camera}, {.splat_order = oracle::SplatOrder::exact});
    const double exact =
        psnr(drawn(scene, camera, in_order, {}, splatting::BlendOrder::along_rays), expected);
    EXPECT_GE(exact, 65) << distance;
    // The order matters here.
    EXPECT_LE(psnr(drawn(scene, camera), expected), 50) << distance;
  }
}

TEST_P(TilesOfKind, AreTheSameWithMoreThreads) {
  const Scene scene = scene_of(random_splats(GetParam(), 2000, 0.1, 2));
  const Camera camera = camera_of_ball(2, 64, 48);
  EXPECT_EQ(drawn(scene, camera), drawn(scene, camera, in_threads));
}

TEST_P(TilesOfKind, OfSeveralLayersShareOneOrder) {
  Scene scene = over_black(scene_of(random_splats(GetParam(), 2000, 0.1, 3)));
  scene.layers.push_back({.primitives = random_splats(splat_kinds[1], 2000, 0.1, 4)});
  const Camera camera = camera_of_ball(3, 120, 90);
  EXPECT_GE(psnr(drawn(scene, camera), render_oracle(scene, {camera}, {})), 75);
}

/// A wall through the middle of the ball.
TEST_P(TilesOfKind, BehindAnOpaqueSurfaceAreHidden) {
  const Scene scene = scene_of(random_splats(GetParam(), 2000, 0.05, 5));
  const Camera camera = camera_of_ball(3, 64, 48);
  const std::vector<float> wall(64 * 48, 3.0f), far_wall(64 * 48, 100.0f);
  const std::vector<float> hidden = drawn(scene, camera, in_order, wall);
  EXPECT_EQ(drawn(scene, camera, in_order, far_wall), drawn(scene, camera));
  // Neural densities may be negative behind the wall, and their alpha is that of the whole chord.
  const bool is_monotonic = GetParam().kernel != SplatKind::Kernel::neural;
  double with = 0, without = 0;
  const std::vector<float> all = drawn(scene, camera);
  for (std::size_t i = 3; i < all.size(); i += 4) {
    // 1e-6: rounding of the product of transmittances.
    EXPECT_TRUE(!is_monotonic || hidden[i] <= all[i] + 1e-6f) << hidden[i] << ' ' << all[i];
    with += double(hidden[i]);
    without += double(all[i]);
  }
  EXPECT_GT(with, 0.3 * without);
  EXPECT_LT(with, 0.95 * without);
}

constexpr auto kind_name = [](const auto& each) { return std::string(each.param.name); };
INSTANTIATE_TEST_SUITE_P(, TilesOfKind, testing::ValuesIn(splat_kinds), kind_name);
// The depth along a ray depends on the layer's class: windows of either colouring, Gaussians, discs
// and neural densities. Other profiles of the same class are thorough.
INSTANTIATE_TEST_SUITE_P(, TilesInExactOrder,
                         testing::Values(splat_kinds[0], splat_kinds[1], splat_kinds[4],
                                         splat_kinds[6], splat_kinds[7]),
                         kind_name);
INSTANTIATE_TEST_SUITE_P(Thorough, TilesInExactOrder,
                         testing::Values(splat_kinds[2], splat_kinds[3], splat_kinds[5]),
                         kind_name);

}  // namespace tile_renderer_test
}  // namespace tureen::test
