// Large weights and critical opacities: cases M1 to M5.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "image/quantise.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/plan/color_mlp_source.hpp"
#include "runtime/prepared_scene.hpp"
#include "runtime/render_options.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/numerics/half_network.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/shader_probe.hpp"
#include "tests/trainer/fragments.hpp"
#include "tests/trainer/host_machine.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/diffsoup/cuda/kernel_backend.hpp"
#include "trainer/diffsoup/kernels/color_network.hpp"

namespace tureen::test {
namespace weights_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

// -- M1, M3: the network -------------------------------------------------------------------------

struct Sample {
  std::array<double, 7> features;
  glm::dvec3 to_eye;
};

std::vector<Sample> random_samples(Random& random, int count) {
  std::vector<Sample> samples;
  for (int i = 0; i < count; ++i) {
    Sample sample;
    for (double& f : sample.features) f = double(float(random.uniform()));
    sample.to_eye = glm::dvec3(glm::vec3(random.direction()));
    samples.push_back(sample);
  }
  return samples;
}

ColorMlp scaled_network(double gain) {
  Random random(21);
  ColorMlp mlp = random_lattice_mlp(random);
  for (DenseLayer& layer : mlp.layers)
    for (float& weight : layer.weights) weight *= float(gain);
  return mlp;
}

/// The largest change of a colour by float roundings. A sum of n products has an error of n + 1
/// units of the sum of their magnitudes (Higham, "Accuracy and Stability of Numerical Algorithms",
/// 3.1), for each layer. A ReLU passes an error on; the sigmoid passes at most a quarter.
double rounding_bound(const ColorMlp& mlp, const Sample& sample) {
  const auto basis = harmonics::basis(sample.to_eye);
  std::vector<double> x(sample.features.begin(), sample.features.end()), error(7, 0.0);
  for (int i = 0; i < 9; ++i) {
    x.push_back(basis[std::size_t(i)]);
    // The worst term is c (2 zz - xx - yy), c = 0.316. Roundings of its squares add up to 2, those
    // of two differences of at most 2 to 4, those of c and of the product, at most 2 c, to 2 each.
    error.push_back((2 + 4 + 2 * 2) * 0.316 * epsilon);
  }
  double result = 0;
  for (const DenseLayer& layer : mlp.layers) {
    std::vector<double> y, passed;
    for (int o = 0; o < layer.outputs; ++o) {
      double sum = layer.biases[std::size_t(o)], magnitude = std::abs(sum), through = 0;
      for (int i = 0; i < layer.inputs; ++i) {
        const double w = layer.weights[std::size_t(o) * layer.inputs + i];
        sum += w * x[std::size_t(i)];
        magnitude += std::abs(w) * (std::abs(x[std::size_t(i)]) + error[std::size_t(i)]);
        through += std::abs(w) * error[std::size_t(i)];
      }
      y.push_back(sum);
      passed.push_back(through + (layer.inputs + 1) * epsilon * magnitude);
    }
    if (&layer == &mlp.layers.back())
      for (std::size_t o = 0; o < y.size(); ++o) {
        // The slope is largest where |sum| is smallest.
        const double least = std::max(std::abs(y[o]) - passed[o], 0.0);
        const double s = 1 / (1 + std::exp(-least)), slope = s * (1 - s);
        // exp(x) may be wrong by 3 + 2 |x| units in the last place (GLSL 4.50, 4.7.1); sum,
        // quotient and the blend of two colours are five roundings of values of at most 1.
        const double sigmoid = (passed[o] + (3 + 2 * std::abs(y[o])) * 2 * epsilon) * slope;
        result = std::max(result, std::min(1.0, sigmoid) + 5 * epsilon);
      }
    for (double& value : y) value = std::max(value, 0.0);
    x = y;
    error = passed;
  }
  return result;
}

double difference(const glm::dvec3& a, const glm::dvec3& b) {
  double most = 0;
  for (int c = 0; c < 3; ++c) {
    const double d = std::abs(a[c] - b[c]);
    most = std::isfinite(d) ? std::max(most, d) : infinity;
  }
  return most;
}

std::vector<glm::vec4> on_device(const ColorMlp& mlp, MlpWeights kind,
                                 const std::vector<Sample>& samples) {
  const ColorMlpSource source = color_mlp_source(mlp, kind);
  // A sample needs three texels: one from the probe's inputs, two from `more`.
  const Probe probe(
      shared_context().capabilities().api,
      source.text +
          "uniform sampler2D more;\n"
          "vec4 probe(vec4 x) { int i = int(gl_FragCoord.x); vec4 second = texelFetch(more, "
          "ivec2(2 * i, 0), 0); vec4 third = texelFetch(more, ivec2(2 * i + 1, 0), 0); "
          "return vec4(color_mlp(x, second, third.xyz), 0.0); }",
      {{"HARMONICS_DEGREE", "2"}});
  std::vector<glm::vec4> inputs, more;
  for (const Sample& s : samples) {
    inputs.emplace_back(s.features[0], s.features[1], s.features[2], s.features[3]);
    more.emplace_back(s.features[4], s.features[5], s.features[6], 0);
    more.emplace_back(glm::vec3(s.to_eye), 0);
  }
  constexpr TargetFormat rgba32f{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
  glActiveTexture(GL_TEXTURE1);
  const gl::Texture texture = make_target(rgba32f, int(more.size()), 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, int(more.size()), 1, GL_RGBA, GL_FLOAT, more.data());
  const gl::Program& program = probe.program();
  program.set("more", 1);
  program.set("mlp_weights", std::span<const glm::mat4>(source.weights));
  program.set("mlp_biases", std::span<const glm::vec4>(source.biases));
  return probe.run(inputs);
}

TEST(Numerics, M1_NetworksOfLargeWeights) {
  Recorder recorder({.stressed =
                         "a network with large weights: its shader, weights as constants and "
                         "as uniforms, against double",
                     .parameter = "gain of the weights",
                     .unit = "error of a channel, where it is nearest to its bound",
                     .naive = "the network in half precision"});
  Random random(1);
  const std::vector<Sample> samples = random_samples(random, 1000);
  for (const double gain : {1.0, 4.0, 16.0, 64.0, 250.0, 1000.0}) {
    const ColorMlp mlp = scaled_network(gain);
    double ours = 0, tolerance = 1, naive = 0;
    for (const MlpWeights kind : {MlpWeights::constants, MlpWeights::uniforms}) {
      const std::vector<glm::vec4> shown = on_device(mlp, kind, samples);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const glm::dvec3 truth = evaluate(mlp, samples[i].features, samples[i].to_eye);
        const double bound = rounding_bound(mlp, samples[i]);
        const double error = difference(glm::dvec3(shown[i]), truth);
        if (error / bound >= ours / tolerance) {
          ours = error;
          tolerance = bound;
        }
        naive = worse(
            naive,
            difference(evaluate_in_halves(mlp, samples[i].features, samples[i].to_eye), truth));
      }
    }
    recorder.add({.at = gain, .naive = naive, .ours = ours, .tolerance = tolerance});
  }
}

/// Expects that the shader requests no lower precision. Without a qualifier, the default in its
/// head applies. A rendered image cannot show this, because desktop OpenGL ignores these
/// qualifiers.
void expect_high_precision(const std::string& glsl) {
  for (const char* word : {"mediump", "lowp"})
    EXPECT_FALSE(std::regex_search(glsl, std::regex("\\b" + std::string(word) + "\\b")))
        << word << " in\n"
        << glsl;
}

/// All our fragment and compute shaders that contain the network, assembled for a soup with a
/// network.
std::vector<std::string> shaders_with_a_network(bool specialise, gl::Api to) {
  const TriangleSoup soup = random_soup(31, {.kind = Kind::lattice_mlp});
  const AppearanceSource appearance =
      prepare_scene(soup, glm::dvec3(0), DeviceLimits{}, {.plan = {.specialise = specialise}})
          .layers.front()
          .soup->appearance;
  std::vector<std::string> shaders;
  for (const char* file :
       {"forward.frag", "visibility.frag", "shading.frag", "shading.comp", "debug_view.frag"}) {
    // Their other constants do not matter: the text contains the parts that #if skips, too.
    ShaderSource source{
        .file = file,
        .constants = appearance.constants,
        .generated = {{"appearance.glsl", appearance.glsl},
                      {"debug_view_appearance.glsl", "#include \"debug_view_lattice.glsl\"\n"}}};
    shaders.push_back(assemble(source, to));
  }
  return shaders;
}

TEST(Numerics, M3_AMediumPrecisionWouldShow) {
  Recorder recorder({.stressed = "the network on a device with 16-bit mediump: the shaders request "
                                 "highp",
                     .parameter = "gain of the weights",
                     .unit = "largest error of a channel",
                     .naive = "mediump: rounded to a half after every operation"});
  for (const MlpWeights kind :
       {MlpWeights::uniforms, MlpWeights::constants, MlpWeights::all_constants})
    expect_high_precision(color_mlp_source(scaled_network(1), kind).text);
  for (const bool specialise : {true, false})
    for (const gl::Api to : {gl::Api::es, gl::Api::desktop})
      for (const std::string& shader : shaders_with_a_network(specialise, to)) {
        ASSERT_NE(shader.find("vec3 predicted"), std::string::npos);  // from the network's body
        ASSERT_NE(shader.find("precision highp float;"), std::string::npos);
        expect_high_precision(shader);
      }
  Random random(3);
  const std::vector<Sample> samples = random_samples(random, 1000);
  for (const double gain : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    const ColorMlp mlp = scaled_network(gain);
    double ours = 0, naive = 0;
    const std::vector<glm::vec4> shown = on_device(mlp, MlpWeights::constants, samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const glm::dvec3 truth = evaluate(mlp, samples[i].features, samples[i].to_eye);
      naive =
          worse(naive,
                difference(evaluate_in_halves(mlp, samples[i].features, samples[i].to_eye), truth));
      ours = worse(ours, difference(glm::dvec3(shown[i]), truth));
    }
    // Half a step of 8 bits: smaller errors cannot be distinguished from rounding.
    recorder.add({.at = gain, .naive = naive, .ours = ours, .tolerance = 0.5 / 255});
  }
}

// -- M2 -----------------------------------------------------------------------------------------

TEST(Numerics, M2_SaturatedSigmoidsHaveAGradient) {
  Recorder recorder({.stressed = "the backward pass of a saturated sigmoid: the trainer's network",
                     .parameter = "bias of the last layer",
                     .unit = "absolute error of the derivative by the bias",
                     .naive = "exp(-x) / (1 + exp(-x))^2 in floats"});
  namespace kernels = trainer::kernels;
  for (const float size : {1.0f, 10.0f, 20.0f, 50.0f, 90.0f, 1e4f, 1e30f}) {
    double ours = 0, naive = 0;
    for (const float bias : {-size, size}) {
      trainer::MlpParameters mlp{}, gradient{};
      for (int c = 0; c < 3; ++c) mlp[std::size_t(kernels::biases3) + c] = bias;
      kernels::NetworkState<float> state{};
      state.input[trainer::blend_channel] = 1;
      float color[3], by_features[kernels::features];
      kernels::shade(mlp.data(), state, color);
      const float by_color[3] = {1, 1, 1};
      kernels::shade_backward(mlp.data(), state, by_color, gradient.data(), by_features);
      // e^-|x| does not overflow.
      const double e = std::exp(-std::abs(double(bias))), truth = e / ((1 + e) * (1 + e));
      for (int c = 0; c < 3; ++c) {
        const double error = std::abs(double(gradient[std::size_t(kernels::biases3) + c]) - truth);
        ours = std::isfinite(error) ? std::max(ours, error) : infinity;
      }
      for (const float g : gradient) ASSERT_TRUE(std::isfinite(g));
      const float f = std::exp(-bias);
      const double error = std::abs(double(f / ((1 + f) * (1 + f))) - truth);
      naive = std::isfinite(error) ? std::max(naive, error) : infinity;
    }
    // s has an error of 2 epsilon: the exponential's two units times a slope of a quarter, then two
    // roundings. s (1 - s) passes on at most that, and is rounded twice, at most 1/4.
    recorder.add({.at = size, .naive = naive, .ours = ours, .tolerance = (2.5 + 0.5) * epsilon});
  }
}

// -- M4, M5: alpha about its threshold -----------------------------------------------------------

constexpr int side = 48;

/// One large triangle with a constant alpha, in each kind of appearance.
TriangleSoup of_constant_alpha(Kind kind, float alpha, int level, bool bytes) {
  TriangleSoup soup = soup_of({{-2, -2, -1.5f}, {2.5f, -1.5f, -2.5f}, {0.3f, 3, -2}});
  if (kind == Kind::face_colors) {
    std::get<FaceColors>(soup.appearance).rgba[0].a = alpha;
  } else if (kind == Kind::vertex_colors) {
    soup.appearance = VertexColors{
        {glm::vec4(1, 0, 0, alpha), glm::vec4(0, 1, 0, alpha), glm::vec4(0, 0, 1, alpha)}};
  } else {
    LatticeTexture texture;
    texture.patches = {{0, std::uint32_t(level)}};
    const std::size_t values = lattice::texel_count(level) * std::size_t(LatticeTexture::channels);
    std::vector<float> floats(values, 0.3f);
    for (std::size_t i = LatticeTexture::features; i < values; i += LatticeTexture::channels)
      floats[i] = alpha;
    if (bytes) {
      std::vector<std::uint8_t> stored;
      for (std::size_t i = 0; i < values; ++i)
        stored.push_back(i % LatticeTexture::channels == LatticeTexture::features
                             ? quantised_alpha(floats[i])
                             : quantised_unit(floats[i]));
      texture.texels = stored;
    } else {
      texture.texels = floats;
    }
    soup.appearance = texture;
  }
  return soup;
}

TEST(Numerics, M4_AlphasNextToTheThreshold) {
  Recorder recorder({.stressed =
                         "alpha within 1/255 of its threshold, in floats and in bytes: device "
                         "and oracle",
                     .parameter = "alpha",
                     .unit = "pixels on the wrong side",
                     .naive = "bytes by truncation"});
  const Camera camera = straight_camera(side, side, side);
  const double all =
      shown_pixels(faces_of_oracle(of_constant_alpha(Kind::face_colors, 1, 0, false), camera));
  ASSERT_GT(all, 500);
  std::vector<float> alphas;
  for (int i = -8; i <= 8; ++i) alphas.push_back(0.5f + float(i) / (8 * 255));
  alphas.insert(alphas.end(), {std::nextafter(0.5f, 0.0f), std::nextafter(0.5f, 1.0f)});
  std::sort(alphas.begin(), alphas.end());
  for (const float alpha : alphas) {
    const double expected = alpha >= 0.5f ? all : 0;
    double ours = 0;
    struct Form {
      Kind kind;
      bool bytes;
    };
    for (const auto& [kind, bytes] :
         {Form{Kind::face_colors, false}, Form{Kind::vertex_colors, false},
          Form{Kind::lattice, false}, Form{Kind::lattice, true}}) {
      const TriangleSoup soup = of_constant_alpha(kind, alpha, 3, bytes);
      ours += std::abs(shown_pixels(faces_of_oracle(soup, camera)) - expected);
      for (const bool specialise : {true, false})
        ours +=
            std::abs(shown_pixels(draw(shared_context(), soup, glm::dvec3(0), camera,
                                       {.specialise = specialise, .site = ShadingSite::deferred})
                                      .faces) -
                     expected);
    }
    const double truncated = std::floor(255 * double(alpha)) / 255 >= 0.5 ? all : 0;
    recorder.add({.at = double(alpha),
                  .naive = std::abs(truncated - expected),
                  .ours = ours,
                  .tolerance = 0});
  }
}

TEST(Numerics, M5_AlphasOfExactlyOneHalfLeaveNoHoles) {
  Recorder recorder({.stressed =
                         "all texels of alpha at exactly one half: oracle, device, and both "
                         "backends of the trainer",
                     .parameter = "level of the lattice",
                     .unit = "fraction of pixels that are holes",
                     .naive = "the sum of weights times texels in floats"});
  const Camera camera = straight_camera(side, side, side);
  const double all =
      shown_pixels(faces_of_oracle(of_constant_alpha(Kind::face_colors, 1, 0, false), camera));
  for (int level = 0; level <= 5; ++level) {
    const TriangleSoup soup = of_constant_alpha(Kind::lattice, 0.5f, level, false);
    double holes = all - shown_pixels(faces_of_oracle(soup, camera));
    for (const ShadingSite site : {ShadingSite::deferred, ShadingSite::forward})
      for (const bool specialise : {true, false}) {
        const Drawn drawn = draw(shared_context(), soup, glm::dvec3(0), camera,
                                 {.specialise = specialise, .site = site});
        const auto black = [](const glm::u8vec4& p) { return p.r == 0; };
        holes += all - double(drawn.color.pixels.size()) +
                 double(std::count_if(drawn.color.pixels.begin(), drawn.color.pixels.end(), black));
      }

    // A logit of 0 is an alpha of one half, the initial value in training.
    const trainer::test::Faces faces(soup.positions, 0.0f, level);
    trainer::BatchImage image = trainer::test::make_image(camera);
    faces.find(image, trainer::Masking::threshold);
    double in_trainer = 0, by_sum = 0;
    for (const trainer::VisiblePixel& pixel : image.visible) in_trainer += pixel.face != no_face;
    trainer::test::for_each_fragment(image.view,
                                     trainer::kernels::project(image.view, &soup.positions[0].x),
                                     {0, 0, side, side}, [&](const trainer::kernels::Fragment& f) {
                                       const auto at = lattice::footprint(level, f.b0, f.b1);
                                       float alpha = 0;
                                       for (int j = 0; j < 3; ++j)
                                         alpha += at.weights[std::size_t(j)] * 0.5f;
                                       by_sum += alpha >= alpha_threshold;
                                     });
    trainer::TrainingState state;
    state.model = faces.model;
    state.moments.reset_faces(state.model);
    trainer::cuda::KernelBackend<trainer::test::HostMachine<false>> kernels({}, trainer::Config{});
    kernels.upload(state);
    const double on_gpu = double(kernels.visible_pixels({&camera, 1})[0]);
    // In the trainer, a face covers all of its edges, so the reference is its own count for an
    // opaque face.
    const trainer::test::Faces opaque(soup.positions, 200.0f, level);
    opaque.find(image, trainer::Masking::threshold);
    double in_opaque = 0;
    for (const trainer::VisiblePixel& pixel : image.visible) in_opaque += pixel.face != no_face;
    holes += std::abs(in_opaque - in_trainer) + std::abs(in_opaque - on_gpu);
    recorder.add({.at = double(level),
                  .naive = (in_opaque - by_sum) / in_opaque,
                  .ours = holes / all,
                  .tolerance = 0});
  }
}

}  // namespace weights_test
}  // namespace tureen::test
