// Numerical hazards of the blending of splats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/numerics/splat_scenes.hpp"
#include "tests/numerics/splat_tiles.hpp"

namespace tureen::test {
namespace splat_blending_test {

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
    const auto error = [&](SplatFormat target) {
      const auto blended = blended_by_device(scene, camera, {.splat_format = target});
      return std::abs(double(blended[40].a) - expected);
    };
    // A rounding of half an epsilon to one epsilon for each layer, and those of an alpha.
    recorder.add({.at = double(layers),
                  .naive = error(SplatFormat::rgba16f),
                  .ours = error(SplatFormat::rgba32f),
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

/// A splat of each kernel in front of straight_camera(), and its numbers, which a test may spoil.
struct NamedSplat {
  const char* name;
  Splats splats;
  std::vector<float*> numbers;
};

std::vector<NamedSplat> one_splat_of_each_kernel() {
  std::vector<NamedSplat> result;
  const auto add = [&](const char* name, SplatKernel kernel, const char* profile) {
    result.push_back({name, white_splats(std::move(kernel), *profile_named(profile)), {}});
  };
  add("windows",
      TriangleWindows{
          .corners = {{-3, -2, -9}, {3, -2, -9}, {0, 3, -9}}, .sigma = {1}, .opacity = {0.8f}},
      "triangle-splatting");
  Gaussians gaussians{.centers = {{0, 0, -9}},
                      .scales = {{1, 2, 1.5f}},
                      .rotations = {{1, 0, 0, 0}},
                      .opacity = {0.8f}};
  add("Gaussians", gaussians, "3dgs");
  gaussians.flat = true;
  add("discs", gaussians, "2dgs");
  NeuralDensities densities{.centers = {{0, 0, -9}},
                            .semi_axes = {{1, 2, 1.5f}},
                            .rotations = {{1, 0, 0, 0}},
                            .networks = std::vector<float>(NeuralDensities::parameters, 0.3f)};
  add("neural densities", std::move(densities), "splatnet");
  const auto collect = [](std::vector<float*>& to, auto& from) {
    auto* numbers = reinterpret_cast<float*>(from.data());
    for (std::size_t i = 0; i < from.size() * sizeof(from[0]) / sizeof(float); ++i)
      to.push_back(&numbers[i]);
  };
  for (NamedSplat& each : result) {
    if (auto* windows = std::get_if<TriangleWindows>(&each.splats.kernel)) {
      collect(each.numbers, windows->corners);
      collect(each.numbers, windows->sigma);
      collect(each.numbers, windows->opacity);
    } else if (auto* of_discs = std::get_if<Gaussians>(&each.splats.kernel)) {
      collect(each.numbers, of_discs->centers);
      collect(each.numbers, of_discs->scales);
      if (of_discs->flat) each.numbers.pop_back();  // the third scale of a disc is not used
      collect(each.numbers, of_discs->rotations);
      collect(each.numbers, of_discs->opacity);
    } else {
      auto& neural = std::get<NeuralDensities>(each.splats.kernel);
      collect(each.numbers, neural.centers);
      collect(each.numbers, neural.semi_axes);
      collect(each.numbers, neural.rotations);
      collect(each.numbers, neural.networks);
    }
  }
  return result;
}

/// Pixels that are not finite, or have an alpha outside 0..1.
double poisoned(const std::vector<glm::vec4>& pixels) {
  double number = 0;
  for (const glm::vec4& p : pixels)
    number += !(std::isfinite(p.r + p.g + p.b) && p.a >= 0 && p.a <= 1 + 4 * float(epsilon));
  return number;
}

TEST(Numerics, B3_ValuesThatAreNotFinitePoisonNoPixel) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Camera camera = straight_camera(8, 6, 8);
  const Scene behind = layers_of(1, 0.5f, *profile_named("3dgs"), false);
  const std::vector<glm::vec4> cleans[] = {blended_by_device(behind, camera),
                                           blended_by_tiles(behind, camera)};
  std::size_t kernel = 0;
  for (const NamedSplat& named : one_splat_of_each_kernel()) {
    Recorder recorder({.stressed = std::string("a number of a splat is not finite: ") + named.name,
                       .parameter = "1: NaN, 2: infinity, 3: -infinity",
                       .unit = "pixels that are not numbers, and frames that a NaN changes",
                       .naive = "skip alpha < 1/255, which NaN is not"});
    double at = 0;
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
      double ours = 0;
      for (std::size_t i = 0; i < named.numbers.size(); ++i) {
        NamedSplat bad = std::move(one_splat_of_each_kernel()[kernel]);
        *bad.numbers[i] = value;
        Scene scene = behind;
        scene.layers.push_back({.primitives = std::move(bad.splats)});
        gl::Context& context = shared_context();
        for (const SplatBlending blending : {SplatBlending::raster, SplatBlending::tiles}) {
          const std::vector<glm::vec4>& clean = cleans[blending == SplatBlending::tiles];
          const RenderOptions options{.plan = {.specialise = false, .splat_blending = blending},
                                      .splat_format = SplatFormat::rgba32f};
          Renderer renderer(context,
                            prepare_scene(scene, device_limits(context.capabilities()), options),
                            options);
          renderer.draw({camera});
          ours += std::isnan(value) ? double(renderer.read_splats() != clean)
                                    : poisoned(renderer.read_splats());
          renderer.show_layer(1, false);
          renderer.draw({camera});
          ours += double(renderer.read_splats() != clean);
        }
      }
      // A Gaussian with a rotation or a scale that is not finite.
      double naive = 0;
      for (int i = 0; i < camera.width * camera.height; ++i) {
        const float alpha = 0.8f * std::exp(-0.5f * (value - value));
        if (!(alpha < 1 / 255.0f)) naive += std::isnan(alpha);
      }
      recorder.add({.at = ++at, .naive = naive, .ours = ours, .tolerance = 0});
    }
    ++kernel;
  }
}

TEST(Numerics, B4_StillsOfManySamplesKeepTheirMean) {
  Recorder recorder({.stressed = "stills of many samples a pixel",
                     .parameter = "samples",
                     .unit = "of a channel",
                     .naive = "running mean of the samples in 8 bits"});
  const Camera camera = straight_camera(5, 3, 5);
  Gaussians gaussians;
  for (int i = 0; i < 5; ++i) {
    gaussians.centers.emplace_back(i - 2, 0.3f * float(i % 2), -5);
    gaussians.scales.emplace_back(0.1f + 0.1f * float(i));
    gaussians.rotations.emplace_back(1, 0, 0, 0);
    gaussians.opacity.push_back(0.9f);
  }
  const Scene scene = scene_of(white_splats(gaussians, *profile_named("3dgs")));
  gl::Context& context = shared_context();
  for (const int along_axis : {2, 4, 8}) {
    const RenderOptions options{.plan = {.quality = {.supersampling = along_axis}}};
    Renderer renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                      options);
    renderer.draw({camera});
    const Image8 image = renderer.read_color();
    const std::vector<glm::vec4> samples = renderer.read_splats();
    const int columns = camera.width * along_axis;
    double naive = 0, ours = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        double sum = 0;
        double running = 0, frames = 0;
        for (int row = y * along_axis; row < (y + 1) * along_axis; ++row)
          for (int column = x * along_axis; column < (x + 1) * along_axis; ++column) {
            const double sample = samples[std::size_t(row * columns + column)].r;
            sum += sample;
            running = std::round(255 * (running + (sample - running) / ++frames)) / 255;
          }
        const double mean = sum / (along_axis * along_axis);
        naive = worse(naive, std::abs(running - mean));
        const double shown = image.pixels[std::size_t(y * camera.width + x)].r / 255.0;
        ours = worse(ours, std::abs(shown - mean));
      }
    // Every sample is rounded to 8 bits, and so is their mean.
    recorder.add({.at = double(along_axis * along_axis),
                  .naive = naive,
                  .ours = ours,
                  .tolerance = 1.0 / 255 + 1e-5});
  }
}

TEST(Numerics, B5_SplatsBehindNearlyClosedPixelsKeepTheirLight) {
  Recorder recorder({.stressed = "a bright splat behind a transmittance of 0.0098",
                     .parameter = "its colour",
                     .unit = "of a channel",
                     .naive = "end the pixel at a splat that lowers the transmittance below 1e-4"});
  const Camera camera = straight_camera(9, 9, 9);
  for (const float brightness : {1.0f, 10.0f, 100.0f}) {
    SplatProfile profile = *profile_named("3dgs");
    profile.low_pass = SplatProfile::LowPass::none;
    Scene scene = layers_of(3, 0.99f, profile, false);
    auto& splats = std::get<Splats>(scene.layers[0].primitives);
    auto& gaussians = std::get<Gaussians>(splats.kernel);
    gaussians.opacity = {0.98f, 0.51f, 0.99f};
    splats.color.coefficients[0] = splats.color.coefficients[1] = glm::vec3(-0.5f / 0.28209479f);
    splats.color.coefficients[2] = glm::vec3((brightness - 0.5f) / 0.28209479f);
    double transmittance = 1, expected = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double alpha = gaussians.opacity[i];
      expected = transmittance * alpha * double(brightness);  // the last one's
      transmittance *= 1 - alpha;
    }
    const OracleImage stopped = render_oracle(scene, {camera}, {.background = {}});
    // The oracle's colours are clamped, so its light is found from its transmittance.
    const double open = 1 - stopped.splat_alpha[40];
    const double naive = open > 1e-3 ? expected : 0;
    const std::vector<glm::vec4> blended = blended_by_device(scene, camera);
    // Roundings of three alphas near 1, whose transmittances are small; and of the colour.
    recorder.add({.at = double(brightness),
                  .naive = naive,
                  .ours = std::abs(double(blended[40].r) - expected),
                  .tolerance = (4 * epsilon + 8 * 0.0098 * epsilon) * double(brightness)});
  }
}

/// Small Gaussians in the middles of pixels, one a pixel, 10 before straight_camera(256, 257, 256)
/// or behind it.
struct SplatsOfPixels {
  static constexpr int columns = 256, rows = 258;
  Gaussians gaussians;

  void add(std::size_t pixel, bool is_behind) {
    const double x = double(pixel % columns) + 0.5 - columns / 2.0,
                 y = rows / 2.0 - double(pixel / columns) - 0.5;
    gaussians.centers.emplace_back((is_behind ? -x : x) * 10 / columns, y * 10 / columns,
                                   is_behind ? 10 : -10);
    gaussians.scales.emplace_back(0.25f * 10 / columns);
    gaussians.rotations.emplace_back(1, 0, 0, 0);
    gaussians.opacity.push_back(0.9f);
  }
};

TEST(Numerics, B6_EverySplatAroundTheEndOfAChunkIsDrawn) {
  Recorder recorder({.stressed = "numbers of splats around that of a chunk",
                     .parameter = "splats",
                     .unit = "splats that are not seen, or twice",
                     .naive = "indices of 16 bits",
                     .naive_fails_from = 65'537,
                     .naive_holds_below = 65'537});
  SplatProfile profile = *profile_named("3dgs");
  profile.low_pass = SplatProfile::LowPass::none;
  const Camera front =
      straight_camera(SplatsOfPixels::columns, SplatsOfPixels::rows, SplatsOfPixels::columns);
  Camera back = look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 1, front.width, front.height);
  back.fx = back.fy = front.fx;
  const auto seen = [](Renderer& renderer, const Camera& camera) {
    renderer.draw({camera});
    double number = 0;
    for (const glm::vec4& pixel : renderer.read_splats()) number += pixel.a > 0.5f;
    return number;
  };
  gl::Context& context = shared_context();
  for (const std::size_t number : {0u, 1u, 2u, 65'535u, 65'536u, 65'537u}) {
    // The last splat alone is behind the eye.
    SplatsOfPixels splats;
    for (std::size_t i = 0; i < number; ++i) splats.add(i, i > 0 && i + 1 == number);
    const Scene scene = scene_of(white_splats(splats.gaussians, profile));
    Renderer renderer(context, prepare_scene(scene, device_limits(context.capabilities()), {}), {});
    const double expected_behind = number > 1 ? 1 : 0;
    const double ours = std::abs(seen(renderer, front) + expected_behind - double(number)) +
                        std::abs(seen(renderer, back) - expected_behind);
    double naive = 0;
    for (std::size_t i = 0; i < number; ++i) naive += std::uint16_t(i) != i;
    recorder.add({.at = double(number), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

}  // namespace splat_blending_test
}  // namespace tureen::test
