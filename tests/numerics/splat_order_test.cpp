// Numerical hazards of the order in which splats are blended.
#include "runtime/splats/splat_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>

#include "runtime/passes/shader_source.hpp"
#include "runtime/splats/splat_sorter.hpp"
#include "tests/numerics/splat_scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/shader_probe.hpp"

namespace tureen::test {
namespace splat_order_test {

/// These splats in the order of their keys, ties by index.
template <class Key>
std::vector<std::uint32_t> sorted_by(const std::vector<Key>& keys) {
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

/// The largest depth by which a splat comes too late.
double too_late(std::span<const std::uint32_t> sorted, const std::vector<double>& depths) {
  double largest = -std::numeric_limits<double>::infinity(), error = 0;
  for (const std::uint32_t i : sorted) {
    error = worse(error, largest - depths[i]);
    largest = std::max(largest, depths[i]);
  }
  return error;
}

std::vector<std::uint32_t> sorted_by_us(const SplatsInView& view) {
  SplatOrder order;
  order.sort(std::span(&view, 1));
  return {order.splats().begin(), order.splats().end()};
}

TEST(Numerics, Z2_KeysBelowZeroAndNegativeZero) {
  Recorder recorder({.stressed = "depths on both sides of 0, with both zeros",
                     .parameter = "largest depth",
                     .unit = "splats in the wrong place",
                     .naive = "bits of the float as an unsigned key"});
  // Beyond 1e-38 depths are denormal.
  for (const double largest : {1e-40, 1e-20, 1.0, 1e20, 1e38}) {
    std::vector<glm::vec3> centers;
    std::vector<double> depths;
    std::vector<std::uint32_t> bits;
    Random random(8);
    for (int i = 0; i < 1000; ++i) {
      const auto depth = float(random.uniform(-1, 1) * largest);
      // A depth of -0 is a sum of products that all are -0.
      centers.push_back(i % 10 == 0   ? glm::vec3(0.0f)
                        : i % 10 == 1 ? glm::vec3(-0.0f)
                                      : glm::vec3(0, 0, depth));
      const float key = centers.back().z;
      depths.push_back(double(key));
      bits.push_back(0);
      std::memcpy(&bits.back(), &key, sizeof key);
    }
    const std::vector<std::uint32_t> expected = sorted_by(depths);
    const auto wrong = [&](const std::vector<std::uint32_t>& sorted) {
      double number = sorted.size() == expected.size() ? 0 : 1e9;
      for (std::size_t i = 0; i < sorted.size(); ++i) number += sorted[i] != expected[i];
      return number;
    };
    const SplatsInView view{.centers = centers, .axis = {0, 0, 1}};
    recorder.add({.at = largest,
                  .naive = wrong(sorted_by(bits)),
                  .ours = wrong(sorted_by_us(view)),
                  .tolerance = 0});
  }
}

TEST(Numerics, Z4_FarOutliersLeaveTheMiddleInOrder) {
  Recorder recorder({.stressed = "a dense middle of radius 1, and few splats far away",
                     .parameter = "distance of the outliers / units",
                     .unit = "depth by which a splat is too late",
                     .naive = "16-bit keys over the range of depths"});
  for (const float distance : {2.0f, 1e3f, 1e6f, 1e9f}) {
    Random random(5);
    std::vector<glm::vec3> centers;
    for (int i = 0; i < 10'000; ++i)
      centers.emplace_back(glm::vec3(0, 0, 2) + glm::vec3(random.direction()));
    for (const float sign : {-1.0f, 1.0f}) centers.emplace_back(0, 0, sign * distance);
    const SplatsInView view{.centers = centers, .axis = {0, 0, 1}};
    std::vector<double> depths;
    for (const glm::vec3& center : centers) depths.push_back(double(center.z));
    const auto [low, high] = std::minmax_element(depths.begin(), depths.end());
    std::vector<std::uint16_t> keys;
    for (const double depth : depths)
      keys.push_back(std::uint16_t((depth - *low) / (*high - *low) * 65535));
    // Keys are the depths themselves.
    recorder.add({.at = double(distance),
                  .naive = too_late(sorted_by(keys), depths),
                  .ours = too_late(sorted_by_us(view), depths),
                  .tolerance = 0});
  }
}

/// A sorter that is never ready.
class StuckSorter final : public SplatSorter {
 public:
  void begin(std::vector<SplatsInView>) override {}
  bool take(SplatOrder&) override { return false; }
  void forget() override {}
};

TEST(Numerics, Z5_TheOrderAtRestIsThatOfTheView) {
  Recorder recorder({.stressed = "the camera turns about 100,000 splats in one frame",
                     .parameter = "turn / degrees",
                     .unit = "of a channel",
                     .naive = "keep the order of the earlier view"});
  Gaussians gaussians;
  Random random(6);
  constexpr std::size_t number = 100'000;
  for (std::size_t i = 0; i < number; ++i) {
    gaussians.centers.emplace_back(random.direction());
    gaussians.scales.emplace_back(0.01f);
    gaussians.rotations.emplace_back(1, 0, 0, 0);
    gaussians.opacity.push_back(0.9f);
  }
  Scene scene = scene_of(white_splats(gaussians, *profile_named("3dgs")));
  auto& splats = std::get<Splats>(scene.layers[0].primitives);
  for (std::size_t i = 0; i < number; ++i)
    splats.color.coefficients[i] =
        glm::vec3(splats.color.coefficients[i].x * gaussians.centers[i].z);
  const auto camera = [](double degrees) {
    const double angle = degrees * M_PI / 180;
    return look_at({4 * std::sin(angle), 0, 4 * std::cos(angle)}, {0, 0, 0}, {0, 1, 0}, 0.6, 32,
                   24);
  };
  gl::Context& context = shared_context();
  const RenderOptions options{.plan = {.splat_blending = SplatBlending::raster}};
  Renderer renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                    options);
  for (const double turn : {0.5, 1.0, 1.9}) {
    const auto error = [&](std::unique_ptr<SplatSorter> sorter, bool until_at_rest,
                           const std::vector<glm::vec4>& expected) {
      renderer.draw({camera(0)});
      renderer.sort_splats_with(std::move(sorter));
      do renderer.draw({camera(turn)}, Renderer::SplatOrdering::earlier);
      while (until_at_rest && !renderer.splats_in_order());
      double largest = 0;
      const std::vector<glm::vec4> now = renderer.read_splats();
      for (std::size_t i = 0; i < expected.size(); ++i)
        for (int c = 0; c < 4; ++c)
          largest = worse(largest, std::abs(double(now[i][c]) - double(expected[i][c])));
      return largest;
    };
    renderer.draw({camera(turn)});
    const std::vector<glm::vec4> expected = renderer.read_splats();
    recorder.add({.at = turn,
                  .naive = error(std::make_unique<StuckSorter>(), false, expected),
                  .ours = error(std::make_unique<ThreadSplatSorter>(), true, expected),
                  .tolerance = 0});
  }
}

TEST(Numerics, Z6_IndicesBeyondFloatsFindTheirTexels) {
  Recorder recorder({.stressed = "indices of splats in textures of at most 8192 texels a side",
                     .parameter = "first index",
                     .unit = "of 1,000 texels",
                     .naive = "indices as floats",
                     .naive_fails_from = 0x1p24,
                     .naive_holds_below = 0x1p24});
  const TexelLayout layout = TexelLayout::of({.max_texture_size = 8192, .max_array_layers = 2048});
  const Probe probe(shared_context().capabilities().api,
                    "#include \"splat_projected.glsl\"\n"
                    "#include \"texel_store.glsl\"\n"
                    "vec4 probe(vec4 x) {\n"
                    "  uint splat = uint(x.x) + uint(x.y);\n"
                    "  ivec3 texel = texel_position(splat);\n"
                    "  return vec4(projected_position(splat), texel.x + 8192 * texel.y, texel.z);\n"
                    "}",
                    {{"PROJECTED_COLUMNS", "1024"},
                     {"TEXEL_ROW_BITS", std::to_string(layout.row_bits)},
                     {"TEXEL_LAYER_BITS", std::to_string(layout.layer_bits)}});
  for (const std::uint32_t first : {0u, 8192u * 1024 - 1000, 1u << 24, 1u << 25, 1u << 28}) {
    std::vector<glm::vec4> inputs;
    for (std::uint32_t i = 0; i < 1000; ++i) inputs.emplace_back(float(first), float(i), 0, 0);
    const std::vector<glm::vec4> found = probe.run(inputs);
    double naive = 0, ours = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const std::uint32_t splat = first + i;
      const std::uint64_t in_layer = splat % layout.texels_per_layer();
      const glm::vec4 expected(
          float(splat % 1024), float(splat / 1024),
          float(in_layer % (1u << layout.row_bits) + 8192 * (in_layer >> layout.row_bits)),
          float(splat / layout.texels_per_layer()));
      ours += found[i] != expected;
      naive += std::uint32_t(float(first) + float(i)) != splat;
    }
    recorder.add({.at = double(first), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

TEST(Numerics, Z7_InterpenetratingDiscs) {
  // Our order is that of the centres, as of all published splatting; the error of the method is
  // reported, and ours is that of the device.
  Recorder recorder(
      {.stressed = "two discs that cross in the middle of the image",
       .parameter = "angle between them / degrees",
       .unit = "of a channel",
       .naive = "order of the centres, which is ours, against the order at each pixel"});
  const Camera camera = straight_camera(32, 24, 32);
  for (const double degrees : {5.0, 45.0, 120.0}) {
    Gaussians discs;
    discs.flat = true;
    for (const double side : {-0.5, 0.5}) {
      discs.centers.emplace_back(0, 0, -5 + 0.001 * side);
      discs.scales.emplace_back(1);
      discs.rotations.push_back(
          glm::angleAxis(float(side * degrees * M_PI / 180), glm::vec3(0, 1, 0)));
      discs.opacity.push_back(0.8f);
    }
    Scene scene = scene_of(white_splats(discs, *profile_named("redisplats")));
    std::get<Splats>(scene.layers[0].primitives).color.coefficients[0] =
        glm::vec3(-0.5f / 0.28209479f);
    const auto by_oracle = [&](oracle::SplatOrder order) {
      return render_oracle(scene, {camera}, {.splat_order = order});
    };
    const OracleImage center = by_oracle(oracle::SplatOrder::center),
                      exact = by_oracle(oracle::SplatOrder::exact);
    const std::vector<glm::vec4> blended = blended_by_device(scene, camera);
    double naive = 0, ours = 0;
    for (std::size_t i = 0; i < blended.size(); ++i) {
      const double expected = center.color.pixels[i].r;
      naive = worse(naive, std::abs(expected - double(exact.color.pixels[i].r)));
      ours = worse(ours, std::abs(expected - double(blended[i].r)));
    }
    // q = u^2 + v^2 has about 20 roundings of numbers up to 11, relative to q.
    recorder.add({.at = degrees, .naive = naive, .ours = ours, .tolerance = 1e-4});
  }
}

TEST(Numerics, Z1_EqualDepthsAreDrawnTheSameInEveryFrame) {
  Recorder recorder({.stressed = "coincident splats of different colours, 100 frames with turns of "
                                 "180 degrees",
                     .parameter = "splats",
                     .unit = "pixels that change"});
  for (const int number : {2, 20, 300}) {
    const auto all = std::size_t(number);
    const Gaussians gaussians{.centers = std::vector(all, glm::vec3(0, 0, -10)),
                              .scales = std::vector(all, glm::vec3(2)),
                              .rotations = std::vector(all, glm::quat(1, 0, 0, 0)),
                              .opacity = std::vector(all, 0.3f)};
    Splats splats = white_splats(gaussians, *profile_named("3dgs"));
    Random random(4);
    for (glm::vec3& color : splats.color.coefficients) color = glm::vec3(random.direction());
    const Scene scene = scene_of(std::move(splats));
    gl::Context& context = shared_context();
    Renderer renderer(context, prepare_scene(scene, device_limits(context.capabilities()), {}), {});
    const Camera front = look_at({0, 0, 0}, {0, 0, -10}, {0, 1, 0}, 0.8, 24, 18);
    const Camera back = look_at({0, 0, -20}, {0, 0, -10}, {0, 1, 0}, 0.8, 24, 18);
    renderer.draw({front});
    const std::vector<glm::vec4> first = renderer.read_splats();
    double changed = 0;
    for (int frame = 0; frame < 100; ++frame) {
      renderer.draw({back});
      renderer.draw({front});
      const std::vector<glm::vec4> now = renderer.read_splats();
      for (std::size_t i = 0; i < first.size(); ++i) changed += now[i] != first[i];
    }
    recorder.add({.at = double(number), .ours = changed, .tolerance = 0});
  }
}

TEST(Numerics, Z3_TheOrderHoldsFarFromTheOrigin) {
  Recorder recorder({.stressed = "splats and eye far from the origin",
                     .parameter = "offset / units",
                     .unit = "depth by which a splat is too late",
                     .naive = "keys in floats, from which the eye's is subtracted",
                     .naive_fails_from = 1e3});
  for (const double offset : {0.0, 1e3, 1e6}) {
    Random random(5);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -1.5));
    const glm::dvec3 eye = offset * glm::dvec3(1, -0.7, 0.4) - 2.0 * axis;
    std::vector<glm::vec3> centers;
    for (int i = 0; i < 2000; ++i) centers.emplace_back(eye + 2.0 * axis + random.direction());
    const SplatsInView view{.centers = centers, .axis = axis, .offset = glm::dot(axis, eye)};
    std::vector<float> keys;
    for (const glm::vec3& center : centers)
      keys.push_back(glm::dot(glm::vec3(axis), center) - float(view.offset));
    std::vector<double> depths;
    for (const glm::vec3& center : centers)
      depths.push_back(glm::dot(axis, glm::dvec3(center) - eye));
    const std::vector<std::uint32_t> sorted = sorted_by_us(view);
    ASSERT_EQ(sorted.size(), centers.size());
    // Two keys of up to 3, rounded to floats; and the offset, rounded to doubles.
    recorder.add({.at = offset,
                  .naive = too_late(sorted_by(keys), depths),
                  .ours = too_late(sorted, depths),
                  .tolerance = 2 * 3 * epsilon + 8 * 0x1p-53 * offset});
  }
}

}  // namespace splat_order_test
}  // namespace tureen::test
