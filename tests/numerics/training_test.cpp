// Training under stress: cases R1 to R9. For any initial state, a run ends with a finite model and
// reports its number of non-finite values.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/host_machine.hpp"
#include "tests/trainer/random_model.hpp"
#include "trainer/common/kernels/adam.hpp"
#include "trainer/diffsoup/cuda/kernel_backend.hpp"
#include "trainer/diffsoup/kernels/color_network.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::test {
namespace training_test {

using trainer::Backend;
using trainer::Config;
using trainer::TrainingState;
using trainer::TrainingView;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int width = 40, height = 32, steps = 40;

Config short_run(int triangles) {
  Config config;
  config.steps = steps;
  config.batch = 2;
  config.triangles = triangles;
  config.resample_every = 10;
  config.coarse_level = 0;
  config.min_level = 0;
  config.max_level = 1;
  config.lift_at = 0.25f;
  return config;
}

TrainingState random_state(std::uint64_t seed, std::size_t faces) {
  TrainingState state;
  state.model = trainer::test::random_model(
      seed, {.faces = faces, .min_level = 0, .max_level = 0, .logit_deviation = 1.0});
  state.model.origin = glm::dvec3(0.0);
  state.moments.reset_faces(state.model);
  return state;
}

TrainingView random_view(Random& random, const Camera& camera) {
  TrainingView view{.camera = camera, .target = {}, .ignored = {}};
  for (int i = 0; i < 3 * camera.width * camera.height; ++i)
    view.target.push_back(std::uint8_t(random.below(256)));
  return view;
}

std::vector<TrainingView> random_views(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<TrainingView> views;
  for (int i = 0; i < count; ++i)
    views.push_back(random_view(
        random, look_at(5.0 * random.direction(), {0, 0, 0}, {0, 0, 1}, 0.9, width, height)));
  return views;
}

using MakeBackend =
    std::function<std::unique_ptr<Backend>(std::span<const TrainingView>, const Config&)>;

std::vector<MakeBackend> both_backends() {
  return {
      [](std::span<const TrainingView> views, const Config& config) {
        return trainer::make_cpu_backend(views, config, 2);
      },
      [](std::span<const TrainingView> views, const Config& config) -> std::unique_ptr<Backend> {
        return std::make_unique<trainer::cuda::KernelBackend<trainer::test::HostMachine<false>>>(
            views, config);
      }};
}

/// The number of non-finite values in the model and its moments.
double non_finite(const TrainingState& state) {
  double count = 0;
  const auto look = [&](const auto& values) {
    for (const float value : values) count += !std::isfinite(value);
  };
  const auto look_at_vectors = [&](const std::vector<glm::vec3>& values) {
    for (const glm::vec3& v : values)
      for (int i = 0; i < 3; ++i) count += !std::isfinite(v[i]);
  };
  look_at_vectors(state.model.positions);
  look_at_vectors(state.moments.vertex_first);
  look(state.model.logits);
  look(state.model.mlp);
  look(state.moments.first);
  look(state.moments.second);
  look(state.moments.vertex_second);
  look(state.moments.mlp_first);
  look(state.moments.mlp_second);
  look(state.errors);
  return count;
}

/// One run with one backend.
struct Run {
  double bad = 0;       // non-finite losses, and non-finite numbers in the last state
  double end_loss = 0;  // mean of the last ten steps
  TrainingState end;
};

Run run(const MakeBackend& make, std::span<const TrainingView> views, const Config& config,
        const TrainingState& begin) {
  constexpr int last = 10;  // enough to average over the steps' draws
  Run result;
  trainer::Trainer trainer(config, views, make(views, config), begin);
  while (!trainer.done()) {
    const double loss = trainer.step().loss;
    result.bad += !std::isfinite(loss);
    if (trainer.steps_done() > config.steps - last) result.end_loss += loss / last;
  }
  result.end = trainer.state();
  result.bad += non_finite(result.end);
  return result;
}

/// The worse result of both backends.
struct Outcome {
  double bad = 0;
  std::uint64_t min_quarantined = ~std::uint64_t(0), max_quarantined = 0;
  std::uint32_t network_steps = ~std::uint32_t(0);
  bool network_moved = true;
  /// Loss at the end of a run with learning rates of zero, divided by the loss at the end of this
  /// run. Splitting and pruning faces does not improve the former. A trainer that never steps, or
  /// that discards every gradient, has a gain of 1.
  double gain = std::numeric_limits<double>::infinity();
};

Outcome train(const std::vector<TrainingView>& views, const Config& config,
              const TrainingState& begin) {
  Config at_rest = config;
  at_rest.texture_rate = at_rest.mlp_rate = at_rest.vertex_rate = 0;
  // One backend is enough: both draw the same images.
  const double loss_at_rest = run(both_backends()[0], views, at_rest, begin).end_loss;
  Outcome outcome;
  for (const MakeBackend& make : both_backends()) {
    const Run learning = run(make, views, config, begin);
    EXPECT_EQ(learning.end.step, config.steps);
    EXPECT_GT(learning.end.model.faces(), 0u);
    outcome.bad += learning.bad;
    outcome.min_quarantined = std::min(outcome.min_quarantined, learning.end.non_finite);
    outcome.max_quarantined = std::max(outcome.max_quarantined, learning.end.non_finite);
    outcome.network_steps = std::min(outcome.network_steps, learning.end.moments.mlp_steps);
    outcome.network_moved = outcome.network_moved && learning.end.model.mlp != begin.model.mlp;
    outcome.gain = std::min(outcome.gain, loss_at_rest / learning.end_loss);
  }
  return outcome;
}

/// Expects learning without non-finite values: none is counted, and faces and network learn.
void expect_learning(const Outcome& outcome, double at) {
  EXPECT_EQ(outcome.max_quarantined, 0u) << at;
  EXPECT_EQ(outcome.network_steps, std::uint32_t(steps)) << at;
  EXPECT_TRUE(outcome.network_moved) << at;
  EXPECT_GT(outcome.gain, 1) << at;
}

const Case ends_with_numbers(const std::string& stressed, const std::string& parameter,
                             const std::string& naive = {}) {
  return {.stressed = stressed + ": both backends",
          .parameter = parameter,
          .unit = "non-finite numbers in model and moments",
          .naive = naive};
}

/// The number of weights that never move again if every finite gradient is used: their second
/// moment is infinite. Trains the network alone, on pixels with random features.
double frozen_weights(const trainer::MlpParameters& begin) {
  namespace kernels = trainer::kernels;
  trainer::MlpParameters mlp = begin, first{}, second{};
  Random random(19);
  for (int step = 1; step <= steps; ++step) {
    trainer::MlpParameters gradient{};
    for (int pixel = 0; pixel < width * height; ++pixel) {
      kernels::NetworkState<float> state{};
      for (int f = 0; f < kernels::features; ++f) state.input[f] = float(random.uniform());
      const glm::vec3 to_eye(random.direction());
      kernels::harmonics9(to_eye.x, to_eye.y, to_eye.z, state.input + kernels::features);
      float color[3], by_color[3], by_features[kernels::features];
      kernels::shade(mlp.data(), state, color);
      // The gradient of the mean |C - G| for a photograph with random colours.
      for (int c = 0; c < 3; ++c)
        by_color[c] = (color[c] < float(random.uniform()) ? -1.0f : 1.0f) / (3 * width * height);
      kernels::shade_backward(mlp.data(), state, by_color, gradient.data(), by_features);
    }
    const Config config;
    const kernels::AdamStep adam =
        kernels::adam_step(config.mlp_rate, config.beta1, config.beta2, config.epsilon, step);
    for (std::size_t i = 0; i < mlp.size(); ++i)
      if (std::isfinite(gradient[i])) kernels::adam(adam, gradient[i], mlp[i], first[i], second[i]);
  }
  double frozen = 0;
  for (const float number : second) frozen += !std::isfinite(number);
  return frozen;
}

TEST(Numerics, R1_ExplodingGradientsAreSkipped) {
  Recorder recorder(
      ends_with_numbers("a network whose hidden layers amplify and whose last layer attenuates",
                        "gain of a hidden layer", "Adam uses every finite gradient"));
  namespace kernels = trainer::kernels;
  const std::vector<TrainingView> views = random_views(1, 3);
  for (const double gain : {1.0, 1e5, 1e10, 1e12, 1e15}) {
    TrainingState state = random_state(11, 40);
    for (int i = 0; i < trainer::mlp_parameters; ++i) {
      float& value = state.model.mlp[std::size_t(i)];
      // Biases of the second layer are amplified twice.
      if (i < kernels::biases1) value *= float(gain);
      if (i >= kernels::weights2 && i < kernels::biases2) value *= float(gain);
      if (i >= kernels::weights3 && i < kernels::biases3) value /= float(gain * gain);
    }
    const Outcome outcome = train(views, short_run(40), state);
    if (gain == 1) expect_learning(outcome, gain);
    // The network is stepped, by far more than the size of its last layer's weights.
    if (gain == 1e5) {
      EXPECT_EQ(outcome.max_quarantined, 0u);
      EXPECT_EQ(outcome.network_steps, std::uint32_t(steps));
    }
    if (gain >= 1e12) {
      // Only the network's gradient is discarded, in every step; the faces learn.
      EXPECT_EQ(outcome.min_quarantined, std::uint64_t(steps)) << gain;
      EXPECT_EQ(outcome.max_quarantined, std::uint64_t(steps)) << gain;
      EXPECT_EQ(outcome.network_steps, 0u) << gain;
      EXPECT_GT(outcome.gain, 1) << gain;
    }
    recorder.add({.at = gain,
                  .naive = frozen_weights(state.model.mlp),
                  .ours = outcome.bad,
                  .tolerance = 0});
  }
}

TEST(Numerics, R2_VanishingGradientsStayNumbers) {
  Recorder recorder(
      ends_with_numbers("texels whose sigmoids are saturated, a network whose neurons "
                        "are all dead",
                        "size of the logits"));
  const std::vector<TrainingView> views = random_views(2, 3);
  for (const float size : {10.0f, 40.0f, 100.0f, 1e10f, 1e38f}) {
    TrainingState state = random_state(12, 40);
    for (std::size_t i = 0; i < state.model.logits.size(); ++i)
      state.model.logits[i] = i % trainer::channels == trainer::alpha_channel ? size
                              : i % 2                                         ? size
                                                                              : -size;
    for (int i = trainer::kernels::biases1; i < trainer::kernels::weights2; ++i)
      state.model.mlp[std::size_t(i)] = -1e6f;
    const Outcome outcome = train(views, short_run(40), state);
    // All values are finite, so none is counted. Only the network's last biases learn, because dead
    // neurons and saturated sigmoids pass on no gradient.
    expect_learning(outcome, double(size));
    recorder.add({.at = double(size), .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R3_WhatIsNoNumberAtTheStartIsReplaced) {
  Recorder recorder(
      ends_with_numbers("an initial state with texels, corners and weights that are not "
                        "finite",
                        "their number", "they stay: only gradients are checked"));
  const std::vector<TrainingView> views = random_views(3, 3);
  for (const int count : {1, 5, 20}) {
    TrainingState state = random_state(13, 40);
    Random random{std::uint64_t(count)};
    for (int i = 0; i < count; ++i) {
      const float bad = random.chance(0.5) ? nan : -std::numeric_limits<float>::infinity();
      switch (i % 5) {
        case 0:
        case 1:
          state.model.logits[random.below(std::uint32_t(state.model.logits.size()))] = nan;
          break;
        case 2:
          state.model.positions[random.below(std::uint32_t(state.model.positions.size()))].y = bad;
          break;
        case 3:
          state.model.mlp[random.below(trainer::mlp_parameters)] = bad;
          break;
        default:
          state.moments.second[random.below(std::uint32_t(state.moments.second.size()))] = nan;
          break;
      }
    }
    const double at_start = non_finite(state);
    const Config config = short_run(40);
    double naive = 0;
    for (const MakeBackend& make : both_backends()) {
      const auto backend = make(views, config);
      backend->upload(state);
      const std::uint32_t batch[] = {0, 1};
      for (int step = 0; step < 10; ++step)
        backend->step(batch, {.texture = 5e-2f, .mlp = 1e-2f, .vertex = 1e-2f});
      TrainingState end;
      backend->download(end);
      naive += non_finite(end);
    }
    const Outcome outcome = train(views, config, state);
    // Counted once each, with no more during the run.
    EXPECT_EQ(double(outcome.min_quarantined), at_start);
    EXPECT_EQ(double(outcome.max_quarantined), at_start);
    EXPECT_EQ(outcome.network_steps, std::uint32_t(steps));
    EXPECT_GT(outcome.gain, 1);
    recorder.add({.at = double(count), .naive = naive, .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R3b_APixelThatIsNoNumberSparesTheNetwork) {
  Recorder recorder(
      {.stressed = "texels that are not a number in some pixels of a step: both backends",
       .parameter = "of 40 faces with such a texel",
       .unit = "non-finite weights of the network after four steps",
       .naive = "the sum of all pixels' gradients"});
  namespace kernels = trainer::kernels;
  const std::vector<TrainingView> views = random_views(4, 3);
  for (const std::size_t faces : {1u, 10u, 39u}) {
    TrainingState state = random_state(14, 40);
    for (std::size_t face = 0; face < faces; ++face) state.model.face_logits(face)[5] = nan;
    double ours = 0;
    for (const MakeBackend& make : both_backends()) {
      const auto backend = make(views, short_run(40));
      backend->upload(state);
      std::uint64_t counted = 0;
      const std::uint32_t batch[] = {0, 1};
      for (int step = 0; step < 4; ++step)
        counted +=
            backend->step(batch, {.texture = 5e-2f, .mlp = 1e-2f, .vertex = 1e-2f}).non_finite;
      EXPECT_GT(counted, 0u);
      TrainingState end;
      backend->download(end);
      for (const float weight : end.model.mlp) ours += !std::isfinite(weight);
      EXPECT_NE(end.model.mlp, state.model.mlp);
    }
    // The naive method: one such pixel without the check.
    trainer::MlpParameters gradient{};
    kernels::NetworkState<float> pixel{};
    for (float& input : pixel.input) input = 0.5f;
    pixel.input[5] = nan;
    float color[3], by_features[kernels::features];
    const float by_color[3] = {0.1f, 0.1f, 0.1f};
    kernels::shade(state.model.mlp.data(), pixel, color);
    kernels::shade_backward(state.model.mlp.data(), pixel, by_color, gradient.data(), by_features);
    double naive = 0;
    for (const float g : gradient) naive += !std::isfinite(g);
    recorder.add({.at = double(faces), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

TEST(Numerics, R4_PhotographsThatAreAllBlack) {
  Recorder recorder(ends_with_numbers("black photographs", "faces"));
  std::vector<TrainingView> views = random_views(5, 3);
  for (TrainingView& view : views) std::ranges::fill(view.target, std::uint8_t(0));
  for (const int faces : {4, 40, 120}) {
    const Outcome outcome = train(views, short_run(faces), random_state(15, std::size_t(faces)));
    expect_learning(outcome, faces);
    recorder.add({.at = double(faces), .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R5_OneCamera) {
  Recorder recorder(ends_with_numbers("one photograph", "faces"));
  const std::vector<TrainingView> views = random_views(6, 1);
  for (const int faces : {4, 40, 120}) {
    const Outcome outcome = train(views, short_run(faces), random_state(16, std::size_t(faces)));
    expect_learning(outcome, faces);
    recorder.add({.at = double(faces), .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R6_CamerasThatAreTheSame) {
  Recorder recorder(
      ends_with_numbers("photographs from one place that contradict each other", "faces"));
  std::vector<TrainingView> views = random_views(7, 4);
  for (TrainingView& view : views) view.camera = views[0].camera;
  for (const int faces : {4, 40, 120}) {
    const Outcome outcome = train(views, short_run(faces), random_state(17, std::size_t(faces)));
    expect_learning(outcome, faces);
    recorder.add({.at = double(faces), .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R7_ACameraInATriangle) {
  Recorder recorder(ends_with_numbers("an eye that lies in a triangle, on its edge and in a corner",
                                      "distance of the eye from the triangle's plane / units"));
  for (const double distance : {0.0, 1e-30, 1e-8, 1e-3}) {
    TrainingState state = random_state(18, 40);
    // Through the origin, where the eyes are: inside the triangle, on its edge, and in its corner.
    const auto set = [&](std::size_t face, const glm::vec3& a, const glm::vec3& b,
                         const glm::vec3& c) {
      const glm::vec3 off(0, 0, float(distance));
      state.model.positions[3 * face] = a + off;
      state.model.positions[3 * face + 1] = b + off;
      state.model.positions[3 * face + 2] = c + off;
    };
    set(0, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    set(1, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
    set(2, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    // Uniform grey is easy to learn; a few faces learn little from noise.
    std::vector<TrainingView> views;
    for (const glm::dvec3& towards :
         {glm::dvec3(1, 0, 0), glm::dvec3(0.3, 0.2, -1), glm::dvec3(0.2, 1, 1e-9)})
      views.push_back({.camera = look_at({0, 0, 0}, towards, {0.1, 0.2, 1}, 0.9, width, height),
                       .target = std::vector<std::uint8_t>(3 * width * height, 160),
                       .ignored = {}});
    const Outcome outcome = train(views, short_run(40), state);
    expect_learning(outcome, distance);
    recorder.add({.at = distance, .ours = outcome.bad, .tolerance = 0});
  }
}

/// Faces with three corners on a line, and with two or three coincident corners, all exactly on
/// pixel centres of `view`. Then needles of this aspect, with an edge along a row of such centres,
/// so that each wins pixels however thin it is. All at a depth of 2 in front of a camera at the
/// origin.
std::vector<glm::vec3> faces_of_next_to_no_area(const Camera& view, double aspect) {
  std::vector<glm::vec3> corners;
  const auto at_pixel = [&](double x, double y) {
    return glm::vec3(2 * (x - view.cx) / view.fx, 2 * (view.cy - y) / view.fy, -2);
  };
  for (int i = 0; i < 4; ++i) {
    const double x = 8.5 + 5 * i, y = 6.5 + 4 * i;
    const auto step = [&](int n) { return i % 2 ? at_pixel(x + n, y) : at_pixel(x + n, y + n); };
    corners.insert(corners.end(), {step(0), step(2), step(6)});
    corners.insert(corners.end(), {step(0), step(0), step(5)});
    corners.insert(corners.end(), {step(0), step(0), step(0)});
  }
  constexpr double length = 24;
  for (int i = 0; i < 8; ++i) {
    const double y = 4.5 + 3 * i, thick = length / aspect;
    corners.insert(corners.end(), {at_pixel(6, y), at_pixel(6 + length, y),
                                   at_pixel(6, y + (i % 2 ? thick : -thick))});
  }
  return corners;
}

TEST(Numerics, R8_FacesOfNextToNoArea) {
  Recorder recorder(ends_with_numbers("needles that win pixels, and faces without area, in a model",
                                      "aspect of the needles"));
  for (int exponent = 1; exponent <= 7; ++exponent) {
    const double aspect = std::pow(10.0, exponent);
    Random random(21);
    std::vector<TrainingView> views = random_views(9, 2);
    views.push_back(random_view(random, straight_camera(width, height, height)));
    const std::vector<glm::vec3> thin = faces_of_next_to_no_area(views.back().camera, aspect);
    TrainingState state = random_state(21, 40 + thin.size() / 3);
    std::ranges::copy(thin, state.model.positions.begin() + 3 * 40);
    double bad = 0;
    for (const MakeBackend& make : both_backends()) {
      // With a beta1 of 0 the first moments are the gradient; at rates of 0 nothing moves.
      Config config = short_run(int(state.model.faces()));
      config.beta1 = 0;
      const auto backend = make(views, config);
      backend->upload(state);
      const std::uint32_t all[] = {0, 1, 2};
      bad += double(backend->step(all, {.texture = 0, .mlp = 0, .vertex = 0}).non_finite);
      TrainingState gradient;
      backend->download(gradient);
      bad += non_finite(gradient);
      for (const TrainingView& view : views)
        for (const float channel : backend->render(view.camera)) bad += !std::isfinite(channel);
      // Only the needles; faces without area cover nothing.
      int learning = 0;
      for (std::size_t face = 40 + 12; face < state.model.faces(); ++face) {
        double by_corners = 0, by_texels = 0;
        for (std::size_t k = 0; k < 3; ++k)
          by_corners += double(glm::length(gradient.moments.vertex_first[3 * face + k]));
        const std::size_t logits = state.model.texels() * trainer::channels;
        for (std::size_t i = 0; i < logits; ++i)
          by_texels += std::abs(double(gradient.moments.first[face * logits + i]));
        learning += by_corners > 0 && by_texels > 0;
      }
      EXPECT_GE(learning, 4) << aspect;
      for (std::size_t face = 40; face < 40 + 12; ++face)
        EXPECT_EQ(gradient.moments.steps[face], 0u) << aspect << ' ' << face;
    }
    const Outcome outcome = train(views, short_run(int(state.model.faces())), state);
    expect_learning(outcome, aspect);
    recorder.add({.at = aspect, .ours = bad + outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R9_FacesInOnePlane) {
  Recorder recorder({.stressed = "overlapping faces in one plane, ordered by "
                                 "rounding alone: both backends",
                     .parameter = "faces",
                     .unit = "discarded gradients, and non-finite numbers in model and moments"});
  for (const std::size_t faces : {2u, 5u, 20u}) {
    Random random(22);
    // Perpendicular to the axis, inverse depths are equal everywhere; on a slope, up to rounding.
    std::vector<TrainingView> views = {
        random_view(random, straight_camera(width, height, height)),
        random_view(random, look_at({1, 1, 1}, {0.2, -0.1, -2}, {0, 1, 0}, 0.9, width, height))};
    TrainingState state = random_state(22, faces);
    for (glm::vec3& corner : state.model.positions) corner.z = -2;
    double bad = 0;
    for (const MakeBackend& make : both_backends()) {
      const auto backend = make(views, short_run(int(faces)));
      backend->upload(state);
      const std::uint32_t all[] = {0, 1};
      // Nothing moves; each step's draws choose other faces.
      for (int step = 0; step < 20; ++step)
        bad += double(backend->step(all, {.texture = 0, .mlp = 0, .vertex = 0}).non_finite);
      TrainingState end;
      backend->download(end);
      bad += non_finite(end);
      EXPECT_GT(*std::ranges::max_element(end.moments.vertex_second), 0) << faces;
    }
    recorder.add({.at = double(faces), .ours = bad, .tolerance = 0});
  }
}

}  // namespace training_test
}  // namespace tureen::test
