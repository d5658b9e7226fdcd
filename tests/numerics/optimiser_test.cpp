// The optimiser and the loss: cases O1 to O7.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/host_machine.hpp"
#include "trainer/common/cpu/image_loss.hpp"
#include "trainer/common/cuda/kernel.hpp"
#include "trainer/common/kernels/adam.hpp"
#include "trainer/common/kernels/image_loss.hpp"
#include "trainer/diffsoup/cuda/kernel_backend.hpp"
#include "trainer/diffsoup/kernels/color_network.hpp"
#include "trainer/diffsoup/mlp_parameters.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::test {
namespace optimiser_test {

namespace kernels = trainer::kernels;

const trainer::Config defaults;

kernels::AdamStep step_at(double t, float rate = 1) {
  return kernels::adam_step(rate, defaults.beta1, defaults.beta2, defaults.epsilon, t);
}

/// Adam on noise: a run's schedule, moments and state, with random gradients that come from no
/// image. Records the length of steps.
class NoiseBackend final : public trainer::Backend {
 public:
  struct Steps {
    double mean = 0, deviation = 0;  // of |step| over all logits, in units of the rate
  };

  explicit NoiseBackend(std::vector<Steps>& steps) : steps_(steps) {}
  std::string description() const override { return "noise"; }
  void upload(const trainer::TrainingState& state) override {
    state_ = state;
    state_.errors.resize(state.model.faces());
  }
  void download(trainer::TrainingState& state) const override { state = state_; }
  trainer::StepReport step(std::span<const std::uint32_t>, const trainer::Rates&) override {
    const std::size_t each = state_.model.texels() * trainer::channels;
    double sum = 0, squares = 0;
    for (std::size_t face = 0; face < state_.model.faces(); ++face) {
      const kernels::AdamStep adam = step_at(++state_.moments.steps[face]);
      for (std::size_t i = face * each; i < (face + 1) * each; ++i) {
        float step = 0;
        kernels::adam(adam, float(random_.normal()), step, state_.moments.first[i],
                      state_.moments.second[i]);
        sum += double(std::abs(step));
        squares += double(step) * double(step);
      }
    }
    const double count = double(state_.model.faces() * each), mean = sum / count;
    steps_.push_back({mean, std::sqrt(squares / count - mean * mean)});
    ++state_.step;
    return {};
  }
  trainer::StageTimes take_times() override { return {}; }
  std::vector<std::uint64_t> visible_pixels(std::span<const Camera>) override {
    return std::vector<std::uint64_t>(state_.model.faces(), 1);
  }
  std::vector<float> render(const Camera&) override { return {}; }

 private:
  std::vector<Steps>& steps_;
  trainer::TrainingState state_;
  Random random_{1};
};

// Schedule.MomentsFollowTheirFacesThroughAResampling covers the moments of new and removed faces.
TEST(Numerics, O1_RestartedMomentsKick) {
  Recorder recorder({.stressed =
                         "the mean step of noise after a resampling, compared with the steady "
                         "state before it",
                     .parameter = "steps since the resampling",
                     .unit = "difference from the steady state / rates",
                     .naive = "moments are reset at every resampling"});
  constexpr int faces = 100, steady_from = 1000, averaged = 100;
  trainer::Config config;
  config.steps = 2 * steady_from;
  config.resample_every = steady_from;
  config.triangles = faces;  // already the budget, so no face is new
  config.turnover = 0;
  config.coarse_level = config.min_level = config.max_level = 0;
  config.lift_at = 0;  // the lift resets moments, too
  std::vector<trainer::TrainingView> views(1);
  views[0].camera = straight_camera(8, 8, 8);
  views[0].target.assign(3 * 64, 0);
  trainer::TrainingState state;
  Random random(1);
  for (int i = 0; i < 3 * faces; ++i) state.model.positions.emplace_back(random.direction());
  state.model.logits.assign(state.model.faces() * state.model.texels() * trainer::channels, 0.0f);
  state.moments.reset_faces(state.model);
  const auto steps_of_run = [&](bool reset) {
    config.reset_moments = reset;
    std::vector<NoiseBackend::Steps> steps;
    trainer::Trainer trainer(config, views, std::make_unique<NoiseBackend>(steps), state);
    while (trainer.steps_done() < steady_from) trainer.step();
    // The order must change, otherwise the test would prove nothing.
    EXPECT_NE(trainer.state().model.positions, state.model.positions);
    EXPECT_EQ(trainer.state().model.faces(), std::size_t(faces));
    while (trainer.steps_done() < steady_from + averaged) trainer.step();
    return steps;
  };
  const std::vector<NoiseBackend::Steps> carried = steps_of_run(false),
                                         restarted = steps_of_run(true);
  double steady = 0;
  for (int i = steady_from - averaged; i < steady_from; ++i)
    steady += carried[std::size_t(i)].mean / averaged;
  const double logits = double(state.model.logits.size());
  struct Row {
    int since;
    double kick;  // the catalogue's mean step after a reset, in rates, two digits
  };
  for (const auto& [since, kick] : {Row{1, 1.00}, Row{2, 0.64}, Row{10, 0.27}, Row{100, 0.18}}) {
    const auto at = std::size_t(steady_from + since - 1);
    // Four standard errors of the difference of two means over all logits; chance exceeds this once
    // in 16,000 times. The steady mean averages many steps, so its error is smaller.
    const double standard_error = carried[at].deviation * std::sqrt(2 / logits);
    EXPECT_NEAR(restarted[at].mean, kick, 0.005 + 4 * restarted[at].deviation / std::sqrt(logits))
        << since;
    recorder.add({.at = double(since),
                  .naive = std::abs(restarted[at].mean - steady),
                  .ours = std::abs(carried[at].mean - steady),
                  .tolerance = 4 * standard_error});
  }
}

TEST(Numerics, O2_GradientsNextToNothingMoveNothing) {
  Recorder recorder({.stressed = "tiny gradients, the first step of Adam and VectorAdam",
                     .parameter = "gradient",
                     .unit = "step / rates",
                     .naive = "an epsilon of 1e-15"});
  // The tolerance below uses this epsilon.
  EXPECT_GE(defaults.epsilon, 1e-8f);
  for (const float gradient : {1e-44f, 1e-30f, 1e-20f, 1e-16f, 1e-14f, 1e-12f}) {
    float value = 0, first = 0, second = 0;
    kernels::adam(step_at(1), gradient, value, first, second);
    float vector[3] = {}, vector_first[3] = {}, vector_second = 0;
    kernels::vector_adam(step_at(1), {gradient, 0, 0}, vector, vector_first, vector_second);
    float naive = 0, naive_first = 0, naive_second = 0;
    kernels::adam(kernels::adam_step(1, defaults.beta1, defaults.beta2, 1e-15f, 1), gradient, naive,
                  naive_first, naive_second);
    // Where the square underflows, the step is gradient / epsilon. 1 - beta1 has a relative error
    // of 6e-7; a subnormal first moment has an error of one of its steps.
    recorder.add({.at = double(gradient),
                  .naive = std::abs(double(naive)),
                  .ours = std::max(std::abs(double(value)), std::abs(double(vector[0]))),
                  .tolerance = double(gradient) / double(defaults.epsilon) * (1 + 1e-6) +
                               double(std::numeric_limits<float>::denorm_min()) /
                                   (1 - double(defaults.beta1)) / double(defaults.epsilon)});
  }
}

/// Records the rates that a Trainer passes.
class RatesBackend final : public trainer::Backend {
 public:
  explicit RatesBackend(std::vector<trainer::Rates>& rates) : rates_(rates) {}
  std::string description() const override { return "notes"; }
  void upload(const trainer::TrainingState& state) override {
    state_ = state;
    state_.errors.resize(state.model.faces());
  }
  void download(trainer::TrainingState& state) const override { state = state_; }
  trainer::StepReport step(std::span<const std::uint32_t>, const trainer::Rates& rates) override {
    rates_.push_back(rates);
    ++state_.step;
    return {};
  }
  trainer::StageTimes take_times() override { return {}; }
  std::vector<std::uint64_t> visible_pixels(std::span<const Camera>) override {
    return std::vector<std::uint64_t>(state_.model.faces(), 1);
  }
  std::vector<float> render(const Camera&) override { return {}; }

 private:
  std::vector<trainer::Rates>& rates_;
  trainer::TrainingState state_;
};

trainer::TrainingState state_of_one_face() {
  trainer::TrainingState state;
  state.model.positions = {{-1, -1, -2}, {1, -1, -2}, {0, 1, -2}};
  state.model.logits.assign(3 * trainer::channels, 0.0f);
  state.moments.reset_faces(state.model);
  return state;
}

TEST(Numerics, O3_RatesDecayToTheirEnd) {
  Recorder recorder({.stressed = "the rate of the last step, which should be rate x decay",
                     .parameter = "steps",
                     .unit = "relative error",
                     .naive = "a rate in floats multiplied step by step"});
  for (const int steps : {1, 10, 1000, 100'000}) {
    trainer::Config config;
    config.steps = steps;
    config.triangles = 1;
    config.resample_every = steps + 1;
    config.coarse_level = config.min_level = config.max_level = 0;
    std::vector<trainer::TrainingView> views(1);
    views[0].camera = straight_camera(8, 8, 8);
    views[0].target.assign(3 * 64, 0);
    std::vector<trainer::Rates> rates;
    trainer::Trainer trainer(config, views, std::make_unique<RatesBackend>(rates),
                             state_of_one_face());
    while (!trainer.done()) trainer.step();
    ASSERT_EQ(rates.size(), std::size_t(steps));
    const double end = double(config.texture_rate) * double(config.decay);
    float multiplied = config.texture_rate;
    const float factor = std::pow(config.decay, 1.0f / float(steps));
    for (int i = 0; i < steps; ++i) multiplied *= factor;
    // The first step has already decayed once.
    const double first = double(config.texture_rate) * std::pow(double(config.decay), 1.0 / steps);
    // A double rounded to a float.
    recorder.add({.at = double(steps),
                  .naive = std::abs(double(multiplied) / end - 1),
                  .ours = std::max(std::abs(double(rates.back().texture) / end - 1),
                                   std::abs(double(rates.front().texture) / first - 1)),
                  .tolerance = epsilon});
  }
}

TEST(Numerics, O4_StepsTurnWithTheAxes) {
  Recorder recorder({.stressed = "200 steps of a corner, in rotated axes: VectorAdam",
                     .parameter = "angle / degrees",
                     .unit = "units, at steps of 0.01",
                     .naive = "Adam, coordinate by coordinate"});
  for (const double degrees : {1.0, 10.0, 37.0, 90.0, 179.0}) {
    const glm::dmat3 turn(
        glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::normalize(glm::dvec3(1, 2, -3))));
    Random random(4);
    float value[3] = {}, first[3] = {}, second = 0;
    float turned[3] = {}, turned_first[3] = {}, turned_second = 0;
    float plain[2][3] = {}, plain_first[2][3] = {}, plain_second[2][3] = {};
    double ours = 0, naive = 0, length = 0;
    for (int t = 1; t <= 200; ++t) {
      const glm::dvec3 g(random.normal() + 1, random.normal(), 0.01 * random.normal());
      const glm::dvec3 h = turn * g;
      const kernels::AdamStep step = step_at(t, 0.01f);
      kernels::vector_adam(step, {float(g.x), float(g.y), float(g.z)}, value, first, second);
      kernels::vector_adam(step, {float(h.x), float(h.y), float(h.z)}, turned, turned_first,
                           turned_second);
      for (int i = 0; i < 3; ++i) {
        kernels::adam(step, float(g[i]), plain[0][i], plain_first[0][i], plain_second[0][i]);
        kernels::adam(step, float(h[i]), plain[1][i], plain_first[1][i], plain_second[1][i]);
      }
      const auto off = [&](const float(&from)[3], const float(&to)[3]) {
        return glm::length(turn * glm::dvec3(from[0], from[1], from[2]) -
                           glm::dvec3(to[0], to[1], to[2]));
      };
      ours = worse(ours, off(value, turned));
      naive = worse(naive, off(plain[0], plain[1]));
      length += 0.01;
    }
    // A step of at most 0.01 has six roundings: its gradient, moments and a quotient. Each step
    // also rounds the value, which is at most the sum of the steps so far. There are two
    // trajectories; roundings with random signs add up as the root of their number.
    const double tolerance = 2 * std::sqrt(3.0) * std::sqrt(200.0) * (6 * 0.01 + length) * epsilon;
    recorder.add({.at = degrees, .naive = naive, .ours = ours, .tolerance = tolerance});
  }
}

// R3b, and CpuStep in tests/trainer, cover the weights.
TEST(Numerics, O5_APixelThatIsNoNumberIsMaskedAndCounted) {
  Recorder recorder({.stressed =
                         "the network's gradient where pixels are not finite, against that of "
                         "the same images without them: both backends",
                     .parameter = "non-finite pixels of 1280",
                     .unit = "largest difference of a derivative / largest derivative",
                     .naive = "the sum of all pixels' derivatives"});
  constexpr int width = 40, height = 32, strips = 8;
  const Camera camera = straight_camera(width, height, height);
  // Strips side by side, opaque for every draw, so that the pixels ignored by a view belong to the
  // same faces.
  trainer::TrainingState state;
  for (int i = 0; i < strips; ++i)
    for (int half = 0; half < 2; ++half) {
      const float x0 = -1.25f + 0.3125f * float(i), x1 = x0 + 0.3125f, y = half ? -3.0f : 3.0f;
      state.model.positions.insert(state.model.positions.end(),
                                   {{x0, y, -2}, {x1, y, -2}, {half ? x1 : x0, -y, -2}});
    }
  state.model.mlp = trainer::initial_mlp(5);
  Random random(5);
  state.model.logits.resize(state.model.faces() * state.model.texels() * trainer::channels);
  for (std::size_t i = 0; i < state.model.logits.size(); ++i)
    state.model.logits[i] =
        i % trainer::channels == trainer::alpha_channel ? 200.0f : float(random.normal());
  state.moments.reset_faces(state.model);
  const std::vector<std::uint32_t> shown = faces_of_trainer(soup_of(state.model.positions), camera);
  ASSERT_EQ(shown_pixels(shown), width * height);
  trainer::TrainingView view{.camera = camera, .target = {}, .ignored = {}};
  for (int i = 0; i < 3 * width * height; ++i)
    view.target.push_back(std::uint8_t(random.below(256)));

  // With a beta1 of 0 the first moments are the gradient.
  trainer::Config config;
  config.beta1 = 0;
  struct Step {
    trainer::MlpParameters gradient;
    std::uint64_t non_finite;
  };
  const auto step_of = [&](bool kernels, const trainer::TrainingState& begin,
                           const trainer::TrainingView& of) {
    const std::span<const trainer::TrainingView> views(&of, 1);
    std::unique_ptr<trainer::Backend> backend;
    if (kernels)
      backend = std::make_unique<trainer::cuda::KernelBackend<trainer::test::HostMachine<false>>>(
          views, config);
    else
      backend = trainer::make_cpu_backend(views, config, 2);
    backend->upload(begin);
    const std::uint32_t batch[] = {0};
    const trainer::StepReport report = backend->step(batch, {.texture = 0, .mlp = 0, .vertex = 0});
    trainer::TrainingState end;
    backend->download(end);
    return Step{end.moments.mlp_first, report.non_finite};
  };

  for (const std::size_t bad_faces : {1u, 4u, 15u}) {
    trainer::TrainingState bad = state;
    for (std::size_t face = 0; face < bad_faces; ++face)
      bad.model.face_logits(face)[trainer::blend_channel] = std::numeric_limits<float>::quiet_NaN();
    trainer::TrainingView without = view;
    for (const std::uint32_t face : shown) without.ignored.push_back(face < bad_faces);
    const auto bad_pixels =
        double(std::count(without.ignored.begin(), without.ignored.end(), std::uint8_t(1)));
    double ours = 0;
    for (const bool kernels : {false, true}) {
      const Step masked = step_of(kernels, bad, view), expected = step_of(kernels, state, without);
      // Each bad face's texture has a non-finite gradient and is counted, too.
      EXPECT_EQ(masked.non_finite, std::uint64_t(bad_pixels) + bad_faces) << kernels;
      EXPECT_EQ(expected.non_finite, 0u) << kernels;
      double largest = 0, most = 0;
      for (std::size_t i = 0; i < masked.gradient.size(); ++i) {
        largest = std::max(largest, std::abs(double(expected.gradient[i])));
        most = worse(most, std::abs(double(masked.gradient[i]) - double(expected.gradient[i])));
      }
      ASSERT_GT(largest, 0) << kernels;
      ours = worse(ours, most / largest);
    }
    // The naive method: the derivatives of one bad pixel, added to the sum.
    trainer::MlpParameters sum{};
    kernels::NetworkState<float> pixel{};
    pixel.input[trainer::blend_channel] = std::numeric_limits<float>::quiet_NaN();
    float color[3], by_features[kernels::features];
    const float by_color[3] = {0.1f, 0.1f, 0.1f};
    kernels::shade(state.model.mlp.data(), pixel, color);
    kernels::shade_backward(state.model.mlp.data(), pixel, by_color, sum.data(), by_features);
    double naive = 0;
    for (const float derivative : sum) naive = worse(naive, double(derivative));
    // The same sums with zeros for those pixels, so there is no other rounding.
    recorder.add({.at = bad_pixels, .naive = naive, .ours = ours, .tolerance = 0});
  }
}

TEST(Numerics, O6_SumsDoNotDependOnTheirOrder) {
  Recorder recorder(
      {.stressed = "a sum of gradients in two orders: fixed point of the CUDA backend",
       .parameter = "terms",
       .unit = "relative difference of the two sums",
       .naive = "atomic additions of floats"});
  Random random(6);
  for (const int terms : {100, 10'000, 1'000'000}) {
    std::vector<float> gradients;
    for (int i = 0; i < terms; ++i)
      gradients.push_back(float(1e-4 * random.normal() * std::pow(10.0, random.uniform(-4, 0))));
    const auto fixed = [&](const std::vector<float>& values) {
      trainer::cuda::Fixed sum = 0;
      for (const float value : values)
        sum += trainer::cuda::to_fixed(value, trainer::cuda::texture_scale);
      return double(trainer::cuda::from_fixed(sum, trainer::cuda::texture_scale));
    };
    const auto in_floats = [](const std::vector<float>& values) {
      float sum = 0;
      for (const float value : values) sum += value;
      return double(sum);
    };
    const double magnitude =
        std::accumulate(gradients.begin(), gradients.end(), 0.0,
                        [](double sum, float g) { return sum + std::abs(double(g)); });
    std::vector<float> shuffled = gradients;
    for (std::size_t i = shuffled.size(); i > 1; --i)
      std::swap(shuffled[i - 1], shuffled[random.below(std::uint32_t(i))]);
    recorder.add({.at = double(terms),
                  .naive = std::abs(in_floats(gradients) - in_floats(shuffled)) / magnitude,
                  .ours = std::abs(fixed(gradients) - fixed(shuffled)) / magnitude,
                  .tolerance = 0});
    // The result is also the correct sum: each term has an error of at most one unit of the scale,
    // 2^-50.
    const double truth = std::accumulate(gradients.begin(), gradients.end(), 0.0);
    EXPECT_NEAR(fixed(gradients), truth, terms * 0x1p-50 + std::abs(truth) * epsilon);
  }
}

TEST(Numerics, O7_FlatImagesHaveNoNegativeVariance) {
  Recorder recorder({.stressed = "1 - SSIM of flat images that differ by 1/255 in brightness: the "
                                 "loss in floats",
                     .parameter = "brightness",
                     .unit = "relative error",
                     .naive = "E[x^2] - E[x]^2 of both images in floats"});
  constexpr int side = 24;
  for (const int level : {1, 32, 128, 200, 254}) {
    std::vector<float> rendered(3 * side * side), gradient(3 * side * side);
    // Brighter by one step, with noise so small that its variance is lost in floats.
    Random random(9000u + std::uint32_t(level));
    std::vector<std::uint8_t> target(3 * side * side, std::uint8_t(level));
    for (float& value : rendered) value = (float(level) + 1 + 1e-3f * float(random.normal())) / 255;
    const auto loss_of = [&](auto number, std::vector<float>& from) {
      using Real = decltype(number);
      const std::vector<Real> colors(from.begin(), from.end());
      std::vector<Real> by_color(from.size());
      trainer::ImageLossScratch<Real> scratch;
      ThreadPool pool(1);
      return 2 * trainer::image_loss(trainer::ImageLossView<Real>{.width = side,
                                                                  .height = side,
                                                                  .rendered = colors,
                                                                  .target = target,
                                                                  .ignored = {},
                                                                  .l1_weight = 0,
                                                                  .ssim_weight = 1,
                                                                  .gradient = by_color,
                                                                  .pixel_loss = {}},
                                     scratch, pool)
                     .loss;
    };
    const double truth = loss_of(double(), rendered), ours = loss_of(float(), rendered);
    // The definition, window by window.
    double naive = 0;
    int windows = 0;
    constexpr float c1 = 1e-4f, c2 = 9e-4f;
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y + 11 <= side; ++y)
        for (int x = 0; x + 11 <= side; ++x) {
          float a = 0, b = 0, aa = 0, bb = 0, ab = 0;
          for (int j = 0; j < 11; ++j)
            for (int i = 0; i < 11; ++i) {
              const auto w = float(trainer::ssim_weight(std::abs(i - 5)) *
                                   trainer::ssim_weight(std::abs(j - 5)));
              const int row = c * side + y + j;
              const std::size_t at = std::size_t(row) * side + x + i;
              const float p = rendered[at], q = float(target[at]) / 255;
              a += w * p, b += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
            }
          naive += 1 - double((2 * a * b + c1) * (2 * (ab - a * b) + c2) /
                              ((a * a + b * b + c1) * (aa - a * a + bb - b * b + c2)));
          ++windows;
        }
    naive /= windows;
    // The photograph's byte / 255 is rounded, by half a unit of its brightness. Relative to a
    // difference of 1/255 this is `level` times as much, and twice that for the square.
    const double of_bytes = 2 * level;
    // The variance of d is close to 0. It is the difference of two means of about d^2, which have
    // about 50 roundings (three numbers weighted eleven times, twice), with random signs and
    // sqrt(1/3) of a unit each. Its weight is B1 / C2 times that of d^2. The mean over the windows
    // reduces it; the bound is four deviations.
    const double brightness = (2 * level + 1) / 255.0, b1 = brightness * brightness / 2 + c1;
    const double of_variances = 4 * std::sqrt(50 / 3.0) * b1 / double(c2) / std::sqrt(windows);
    // The other factors of d^2 / B1 have twice the 32 roundings of means in each square, and a
    // dozen of their own.
    const double others = 2 * 2 * 32 + 12;
    // For bright images, four deviations exceed 3 x 255, the earlier bound, which has been enough.
    const double tolerance = std::min(of_bytes + of_variances + others, 3.0 * 255) * epsilon;
    recorder.add({.at = level / 255.0,
                  .naive = std::abs(naive / truth - 1),
                  .ours = std::abs(ours / truth - 1),
                  .tolerance = tolerance});
  }
}

}  // namespace optimiser_test
}  // namespace tureen::test
