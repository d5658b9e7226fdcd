// Numerical hazards of the order of splats and of their blending.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/splats/splat_order.hpp"
#include "tests/numerics/splat_scenes.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {
namespace splat_blending_test {

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
    SplatOrder order;
    order.sort(std::span(&view, 1));
    std::vector<float> keys;
    for (const glm::vec3& center : centers)
      keys.push_back(glm::dot(glm::vec3(axis), center) - float(view.offset));
    std::vector<std::uint32_t> by_keys(centers.size());
    std::iota(by_keys.begin(), by_keys.end(), 0u);
    std::stable_sort(by_keys.begin(), by_keys.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    const auto too_late = [&](std::span<const std::uint32_t> sorted) {
      double largest = -1e300, error = 0;
      for (const std::uint32_t i : sorted) {
        const double depth = glm::dot(axis, glm::dvec3(centers[i]) - eye);
        error = std::max(error, largest - depth);
        largest = std::max(largest, depth);
      }
      return error;
    };
    ASSERT_EQ(order.splats().size(), centers.size());
    // Two keys of up to 3, rounded to floats; and the offset, rounded to doubles.
    recorder.add({.at = offset,
                  .naive = too_late(by_keys),
                  .ours = too_late(order.splats()),
                  .tolerance = 2 * 3 * epsilon + 8 * 0x1p-53 * offset});
  }
}

/// Gaussians that cover the image evenly, one behind the other.
Scene layers_of(int number, float opacity, const SplatProfile& profile, bool flat) {
  Gaussians gaussians;
  gaussians.flat = flat;
  for (int i = 0; i < number; ++i) {
    gaussians.centers.emplace_back(0, 0, -10 - 0.001 * i);
    gaussians.scales.emplace_back(1e5f);
    gaussians.rotations.emplace_back(1, 0, 0, 0);
    gaussians.opacity.push_back(opacity);
  }
  return scene_of(white_splats(gaussians, profile));
}

TEST(Numerics, B1_ThousandsOfFaintLayersAddUp) {
  Recorder recorder({.stressed = "layers with an alpha of 1/250",
                     .parameter = "layers",
                     .unit = "alpha",
                     .naive = "blend in half floats"});
  const Camera camera = straight_camera(9, 9, 9);
  for (const int layers : {1, 10, 100, 2000}) {
    SplatProfile profile = *profile_named("3dgs");
    profile.low_pass = SplatProfile::LowPass::none;
    const Scene scene = layers_of(layers, 1 / 250.0f, profile, false);
    const double expected = -std::expm1(layers * std::log1p(-double(1 / 250.0f)));
    const auto error = [&](SplatTarget target) {
      const auto blended = blended_by_device(scene, camera, {.splat_target = target});
      return std::abs(double(blended[40].a) - expected);
    };
    // A rounding of half an epsilon to one epsilon for each layer, and those of an alpha.
    recorder.add({.at = double(layers),
                  .naive = error(SplatTarget::rgba16f),
                  .ours = error(SplatTarget::rgba32f),
                  .tolerance = (layers + 4) * epsilon});
  }
}

TEST(Numerics, B2_OpaqueSplatsHideWhatIsBehind) {
  Recorder recorder({.stressed = "opaque discs in front of others, maximal alpha of 1",
                     .parameter = "discs",
                     .unit = "alpha beyond or below 1",
                     .naive = "alpha of at most 0.99"});
  const Camera camera = straight_camera(9, 9, 9);
  for (const int discs : {1, 2, 100}) {
    const auto error = [&](float max_alpha) {
      SplatProfile profile = *profile_named("redisplats");
      profile.max_alpha = max_alpha;
      const auto blended = blended_by_device(layers_of(discs, 1, profile, true), camera);
      return worse(std::abs(double(blended[40].a) - 1), std::abs(double(blended[40].r) - 1));
    };
    // The rounding of exp, and of a white that is stored as a coefficient.
    recorder.add(
        {.at = double(discs), .naive = error(0.99f), .ours = error(1), .tolerance = 4 * epsilon});
  }
}

TEST(Numerics, Z1_EqualDepthsAreDrawnTheSameInEveryFrame) {
  Recorder recorder({.stressed = "coincident splats of different colours, 100 frames with turns of "
                                 "180 degrees",
                     .parameter = "splats",
                     .unit = "pixels that change"});
  for (const int number : {2, 20, 300}) {
    Scene scene = layers_of(number, 0.3f, *profile_named("3dgs"), false);
    auto& splats = std::get<Splats>(scene.layers[0].primitives);
    auto& gaussians = std::get<Gaussians>(splats.kernel);
    Random random(4);
    for (int i = 0; i < number; ++i) {
      gaussians.centers[std::size_t(i)] = {0, 0, -10};
      gaussians.scales[std::size_t(i)] = glm::vec3(2);
      splats.color.coefficients[std::size_t(i)] = glm::vec3(random.direction());
    }
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

}  // namespace splat_blending_test
}  // namespace tureen::test
