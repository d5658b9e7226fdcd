// The orders of splats other than that of their centres: exact, against the oracle; stochastic, as
// the mean of many frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "oracle/oracle.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/made_once.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace splat_orders_test {

using Order = Quality::SplatOrder;

Renderer renderer_of(const gl::Context& context, const Scene& scene, Order order,
                     SplatBlending blending = SplatBlending::automatic, int supersampling = 1) {
  const RenderOptions options{
      .plan = {.quality = {.supersampling = supersampling, .splat_order = order},
               .splat_blending = blending},
      .background = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)};
  return Renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                  options);
}

/// PSNR in dB of an image of 8 bits against the oracle's.
double psnr_of(const Image8& drawn, const OracleImage& expected) {
  double sum = 0;
  for (std::size_t i = 0; i < drawn.pixels.size(); ++i)
    for (int channel = 0; channel < 3; ++channel)
      sum +=
          std::pow(drawn.pixels[i][channel] / 255.0 - double(expected.color.pixels[i][channel]), 2);
  return -10 * std::log10(sum / (3 * double(drawn.pixels.size())));
}

class SplatOrders : public testing::TestWithParam<InContext<SplatKind>> {
 protected:
  gl::Context context = gl::Context::create(std::get<0>(GetParam()).request);
  SplatKind kind = std::get<1>(GetParam());

  /// Large splats, whose order matters, around a few triangles.
  Scene scene() const {
    Scene scene = scene_of(random_splats(kind, 500, 0.25, 2));
    scene.layers.push_back({.primitives = random_soup(4, {.faces = 10})});
    return scene;
  }
};

TEST_P(SplatOrders, ExactAgreesWithTheOracle) {
  const Scene scene = this->scene();
  const Camera camera = camera_of_ball(2.5, 120, 90);
  OracleOptions options{.splat_order = oracle::SplatOrder::exact};
  options.rays.coverage = oracle::Coverage::snapped;
  const OracleImage& expected =
      made_once(std::string(kind.name), [&] { return render_oracle(scene, {camera}, options); });
  const auto psnr = [&](Order order) {
    Renderer renderer = renderer_of(context, scene, order);
    renderer.draw({camera});
    return psnr_of(renderer.read_color(), expected);
  };
  // The requirement; rounding to 8 bits alone gives 58.9 dB.
  EXPECT_GE(psnr(Order::exact), 55);
  EXPECT_LE(psnr(Order::center), 45) << "the order must matter here";
}

/// With K independent frames, the squared error of their mean is the variance of one frame over K,
/// if the mean is right: both sums over the pixels agree up to their own noise.
TEST_P(SplatOrders, StochasticHasTheMeanOfTheCentersOrder) {
  const Scene scene = this->scene();
  const Camera camera = camera_of_ball(2.5, 48, 36);
  OracleOptions options{.splat_stop = false};
  options.rays.coverage = oracle::Coverage::snapped;
  const OracleImage& expected =
      made_once(std::string(kind.name), [&] { return render_oracle(scene, {camera}, options); });
  Renderer renderer = renderer_of(context, scene, Order::stochastic);
  constexpr int frames = 64;
  const std::size_t pixels = expected.face.size();
  std::vector<glm::dvec4> sums(pixels, glm::dvec4(0)), squares = sums;
  for (int frame = 0; frame < frames; ++frame) {
    // The same image as part of a larger one, elsewhere in each frame: other random numbers.
    Camera whole = camera;
    whole.width += 64 * frame;
    whole.cx += 64 * frame;
    renderer.draw({.camera = camera, .whole = whole});
    const std::vector<glm::vec4> drawn = renderer.read_splats();
    for (std::size_t i = 0; i < pixels; ++i) {
      ASSERT_TRUE(drawn[i].a == 0 || drawn[i].a == 1);
      sums[i] += glm::dvec4(drawn[i]);
      squares[i] += glm::dvec4(drawn[i]) * glm::dvec4(drawn[i]);
    }
  }
  double squared_error = 0, variance = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const glm::dvec4 mean = sums[i] / double(frames);
    const auto add = [&](int channel, double right) {
      squared_error += std::pow(mean[channel] - right, 2);
      variance +=
          (squares[i][channel] / double(frames) - mean[channel] * mean[channel]) / (frames - 1);
    };
    add(3, expected.splat_alpha[i]);
    for (int channel = 0; channel < 3; ++channel)
      // The oracle limits colours to 1, frames do not.
      if (expected.face[i] == no_face && expected.color.pixels[i][channel] < 1)
        add(channel, double(expected.color.pixels[i][channel]));
  }
  // Of about 1,000 pixels with splats, the sum of squared normal errors has a deviation of
  // sqrt(2 / 1000) of its mean, 0.045; the channels of a pixel are not independent, and some
  // pixels have most of the variance: 0.08. Five deviations. A mean that is wrong by the deviation
  // of one sample over sqrt(K) has a ratio of 2.
  EXPECT_GT(variance, 0);
  EXPECT_NEAR(squared_error / variance, 1, 0.4);
}

/// Low passes are in pixels, not in samples. Each sample has 8 bits and colours of at most 1; the
/// mean of 16 has fewer errors than one: 50 dB is far from the 30 dB of a low pass in samples.
TEST_P(SplatOrders, SupersampledAgreeWithTheOracle) {
  const Scene scene = scene_of(random_splats(kind, 2000, 0.05, 2));
  const Camera camera = camera_of_ball(3, 60, 45);
  const OracleImage& expected = made_once(
      std::string(kind.name), [&] { return render_oracle(scene, {camera}, {.supersampling = 4}); });
  for (const SplatBlending blending : {SplatBlending::raster, SplatBlending::tiles}) {
    Renderer renderer = renderer_of(context, scene, Order::center, blending, 4);
    renderer.draw({camera});
    EXPECT_GE(psnr_of(renderer.read_color(), expected), 50);
  }
}

TEST_P(SplatOrders, OfAddedLayersIsThatOfTheScene) {
  const Scene first = scene(), second = scene_of(random_splats(kind, 200, 0.25, 5));
  Scene both = first;
  both.layers.push_back(second.layers[0]);
  const Camera camera = camera_of_ball(2.5, 60, 45);
  const auto drawn = [&](Renderer& renderer) {
    renderer.draw({camera});
    return renderer.read_color();
  };
  const DeviceLimits limits = device_limits(context.capabilities());
  for (const Order order : {Order::center, Order::stochastic}) {
    Renderer expected = renderer_of(context, both, order);
    Renderer renderer = renderer_of(context, first, order);
    // Prepared for another order, as a page does with a file of other quality.
    renderer.add_layers(prepare_scene(second, limits, {}));
    EXPECT_EQ(drawn(renderer).pixels, drawn(expected).pixels);
  }
  Renderer renderer = renderer_of(context, first, Order::exact);
  const Image8 before = drawn(renderer);
  const RenderOptions raster{.plan = {.splat_blending = SplatBlending::raster}};
  EXPECT_THROW(renderer.add_layers(prepare_scene(second, limits, raster)), UsageError);
  EXPECT_EQ(drawn(renderer).pixels, before.pixels);
}

INSTANTIATE_TEST_SUITE_P(, SplatOrders, in_contexts(splat_kinds), name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, SplatOrders, in_other_contexts(splat_kinds), name_in_context);

TEST(SplatOrder, NeedsABlendingThatHasIt) {
  const gl::Context context = gl::Context::create({});
  const Scene scene = scene_of(random_splats(splat_kinds[1], 10, 0.2, 1));
  const auto fails_with = [&](Order order, SplatBlending blending, const std::string& reason) {
    try {
      renderer_of(context, scene, order, blending);
      ADD_FAILURE() << "no error: " << reason;
    } catch (const UsageError& error) {
      EXPECT_EQ(error.reason(), reason);
    }
  };
  fails_with(Order::exact, SplatBlending::raster, "raster does not blend splats in exact order");
  fails_with(Order::stochastic, SplatBlending::tiles, "tiles do not draw stochastic splats");
  // A device that would blend by raster.
  DeviceLimits hardware = device_limits(context.capabilities());
  hardware.software = false;
  const PreparedScene exact =
      prepare_scene(scene, hardware, {.plan = {.quality = {.splat_order = Order::exact}}});
  EXPECT_TRUE(exact.layers[0].tiled_splats);
}

}  // namespace splat_orders_test
}  // namespace tureen::test
