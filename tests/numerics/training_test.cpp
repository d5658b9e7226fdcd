// Training under stress: the rows R1 to R7. However bad its beginning, a run ends with a model that
// is all numbers, and says how many it had to put aside.
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

#include "numerics/recorder.hpp"
#include "numerics/scenes.hpp"
#include "support/random.hpp"
#include "trainer/cuda/kernel_backend.hpp"
#include "trainer/host_machine.hpp"
#include "trainer/kernels/adam.hpp"
#include "trainer/kernels/color_network.hpp"
#include "trainer/random_model.hpp"
#include "trainer/trainer.hpp"

namespace tureen::test {
namespace {

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

/// Numbers of the model and its moments that are none.
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

struct Outcome {
  double bad = 0;                 // numbers of the last state that are none, both backends
  std::uint64_t quarantined = 0;  // the least of both
  double gain = 0;                // first loss over last one, the least of both
};

Outcome train(const std::vector<TrainingView>& views, const Config& config,
              const TrainingState& begin) {
  Outcome outcome{.quarantined = ~std::uint64_t(0),
                  .gain = std::numeric_limits<double>::infinity()};
  for (const MakeBackend& make : both_backends()) {
    trainer::Trainer trainer(config, views, make(views, config), begin);
    double first = 0, last = 0;
    while (!trainer.done()) {
      last = trainer.step().loss;
      if (first == 0) first = last;
      outcome.bad += !std::isfinite(last);
    }
    outcome.gain = std::min(outcome.gain, first / last);
    const TrainingState end = trainer.state();
    EXPECT_EQ(end.step, config.steps);
    EXPECT_GT(end.model.faces(), 0u);
    outcome.bad += non_finite(end);
    outcome.quarantined = std::min(outcome.quarantined, end.non_finite);
  }
  return outcome;
}

const Case ends_with_numbers(const std::string& stressed, const std::string& parameter,
                             const std::string& naive = {}) {
  return {.stressed = stressed + ": both backends",
          .parameter = parameter,
          .unit = "numbers of model and moments that are none",
          .naive = naive};
}

TEST(Numerics, R1_ExplodingGradientsAreLeftOut) {
  Recorder recorder(
      ends_with_numbers("a network whose hidden layers amplify and whose last one takes it back",
                        "gain of a hidden layer", "Adam takes every gradient that is finite"));
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
    // The derivative by a weight of the last layer is a hidden value times up to a quarter.
    double frozen = 0;
    for (int i = kernels::weights3; i < kernels::biases3; ++i) {
      float value = 0, first = 0, second = 0;
      kernels::adam(kernels::adam_step(1e-2f, 0.9f, 0.999f, 1e-8f, 1), float(1e-2 * gain * gain),
                    value, first, second);
      frozen += !std::isfinite(second);
    }
    if (gain >= 1e12) {
      EXPECT_GT(outcome.quarantined, 0u) << gain;
    }
    recorder.add({.at = gain, .naive = frozen, .ours = outcome.bad, .tolerance = 0});
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
    recorder.add({.at = double(size), .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R3_WhatIsNoNumberAtTheStartIsReplaced) {
  Recorder recorder(
      ends_with_numbers("a beginning with texels, corners and weights that are no "
                        "numbers",
                        "how many", "they stay: only gradients are watched"));
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
    EXPECT_GE(double(outcome.quarantined), at_start);
    recorder.add({.at = double(count), .naive = naive, .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R3b_APixelThatIsNoNumberSparesTheNetwork) {
  Recorder recorder(
      {.stressed = "texels that are no numbers in some pixels of a step: both backends",
       .parameter = "faces that have one, of 40",
       .unit = "weights of the network that are none after four steps",
       .naive = "the gradient of all pixels added up"});
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
    // One such pixel without its quarantine.
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
  Recorder recorder(ends_with_numbers("photographs that are black throughout", "faces"));
  std::vector<TrainingView> views = random_views(5, 3);
  for (TrainingView& view : views) std::ranges::fill(view.target, std::uint8_t(0));
  for (const int faces : {4, 40, 120}) {
    const Outcome outcome = train(views, short_run(faces), random_state(15, std::size_t(faces)));
    EXPECT_GT(outcome.gain, 1);  // black is not hard to learn
    recorder.add({.at = double(faces), .ours = outcome.bad, .tolerance = 0});
  }
}

TEST(Numerics, R5_OneCamera) {
  Recorder recorder(ends_with_numbers("one photograph", "faces"));
  const std::vector<TrainingView> views = random_views(6, 1);
  for (const int faces : {4, 40, 120})
    recorder.add({.at = double(faces),
                  .ours = train(views, short_run(faces), random_state(16, std::size_t(faces))).bad,
                  .tolerance = 0});
}

TEST(Numerics, R6_CamerasThatAreTheSame) {
  Recorder recorder(
      ends_with_numbers("photographs from one place that contradict each other", "faces"));
  std::vector<TrainingView> views = random_views(7, 4);
  for (TrainingView& view : views) view.camera = views[0].camera;
  for (const int faces : {4, 40, 120})
    recorder.add({.at = double(faces),
                  .ours = train(views, short_run(faces), random_state(17, std::size_t(faces))).bad,
                  .tolerance = 0});
}

TEST(Numerics, R7_ACameraInATriangle) {
  Recorder recorder(ends_with_numbers("an eye that lies in a triangle, on its edge and in a corner",
                                      "distance of the eye from the triangle's plane / units"));
  Random random(8);
  for (const double distance : {0.0, 1e-30, 1e-8, 1e-3}) {
    TrainingState state = random_state(18, 40);
    // Through the origin, on which the eyes are: within, on an edge, and in a corner of it.
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
    std::vector<TrainingView> views;
    for (const glm::dvec3& towards :
         {glm::dvec3(1, 0, 0), glm::dvec3(0.3, 0.2, -1), glm::dvec3(0.2, 1, 1e-9)})
      views.push_back(
          random_view(random, look_at({0, 0, 0}, towards, {0.1, 0.2, 1}, 0.9, width, height)));
    recorder.add({.at = distance, .ours = train(views, short_run(40), state).bad, .tolerance = 0});
  }
}

}  // namespace
}  // namespace tureen::test
