// Neural densities: starts, densification, and whole runs of their trainer.
#include "trainer/splats/neural/neural_training.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "oracle/oracle.hpp"
#include "tests/trainer/gradient_views.hpp"
#include "tests/trainer/splat_runs.hpp"
#include "trainer/splats/neural/neural_start.hpp"

namespace tureen::trainer {
namespace neural_training_test {

namespace row = splatting::neural_row;

NeuralConfig short_run(int steps) {
  NeuralConfig config;
  config.steps = steps;
  config.max_splats = 300;
  config.first_splats = 200;
  config.densify_every = 40;
  for (float& channel : config.background) channel = 0;
  return config;
}

/// A density with the network of a trained one.
NeuralParameters one_density() {
  Random random(3);
  NeuralParameters result(1, 0);
  NeuralConfig config;
  NeuralTraining::put(config, {.position = {0.1, -0.2, 0.3}, .color = {1, 0.5, 0.2}}, 0.8, random,
                      0, result);
  for (std::size_t r = row::amplitudes; r < row::offset; ++r)
    result.trained(r)[0] = float(random.uniform(-1, 1));
  result.trained(row::semi_axes)[0] -= 0.5f;
  result.trained(row::rotation)[0] = 0.4f;
  result.activate(0);
  return result;
}

OracleImage image_of(const NeuralParameters& parameters) {
  Scene scene;
  scene.layers.push_back({.primitives = parameters.splats()});
  return render_oracle(scene, {test::camera()}, {});
}

/// A part that moves keeps the density at each point: two with the same surface have equal images.
TEST(NeuralDensify, KeepsTheDensity) {
  const NeuralParameters whole = one_density();
  // Larger by a half about another centre, and cut by nothing: compared where both are full.
  NeuralParameters moved = whole;
  reshape_density({0.03f, -0.02f, 0.05f}, {-0.9f, -1, -1.1f}, 0, moved);
  moved.activate(0);
  // Along a ray through both, the optical depths per length are equal: sum over a common part.
  for (int k = 0; k < 50; ++k) {
    Random random(std::uint64_t(k) + 1);
    const glm::dvec3 point(0.1 + random.uniform(-0.2, 0.2), -0.2 + random.uniform(-0.2, 0.2),
                           0.3 + random.uniform(-0.2, 0.2));
    const auto density_at = [&](const NeuralParameters& p) {
      const double largest = std::exp(
          std::max({double(p.trained(row::semi_axes)[0]), double(p.trained(row::semi_axes + 1)[0]),
                    double(p.trained(row::semi_axes + 2)[0])}));
      double sum = double(p.trained(row::offset)[0]);
      for (std::size_t n = 0; n < splatting::neurons; ++n) {
        double phase = double(p.trained(row::phases + n)[0]);
        for (std::size_t axis = 0; axis < 3; ++axis)
          phase += double(p.trained(row::frequencies + 3 * n + axis)[0]) *
                   (point[int(axis)] - double(p.trained(row::center + axis)[0])) / largest;
        sum += double(p.trained(row::amplitudes + n)[0]) * std::cos(phase);
      }
      return sum / largest;
    };
    EXPECT_NEAR(density_at(moved), density_at(whole), 1e-5);
  }
}

/// Halves overlap, so that the image is not the same, but the outside stays empty and the mean
/// alpha is similar.
TEST(NeuralDensify, SplitsAlongTheLongestAxisAndReplacesTheDead) {
  NeuralParameters parameters = one_density();
  parameters.enlarge(3);
  for (const std::size_t place : {1u, 2u}) {
    parameters.copy(0, place);
    parameters.activate(place);
  }
  SplatMemory memory(parameters.rows(), 3);
  for (std::size_t i = 0; i < 3; ++i) {
    memory.statistics.row(splat_statistic::motion)[i] = i == 0;
    memory.statistics.row(splat_statistic::evident)[i] = i != 1;
  }
  Random random(1);
  const DensifyReport report = densify_densities({.max_splats = 3}, random, parameters, memory);
  EXPECT_EQ(report.dead, 1u);
  EXPECT_EQ(report.split, 1u);
  // The two longest semi-axes are equal; the first of them is divided.
  const float length = std::exp(parameters.trained(row::semi_axes + 2)[2]);
  EXPECT_FLOAT_EQ(std::exp(parameters.trained(row::semi_axes + 1)[0]), 0.6f * length);
  EXPECT_FLOAT_EQ(std::exp(parameters.trained(row::semi_axes + 1)[1]), 0.6f * length);
  const glm::vec3 between = parameters.center(0) - parameters.center(1);
  EXPECT_NEAR(glm::length(between), length, 1e-5);
  const glm::vec3 middle = 0.5f * (parameters.center(0) + parameters.center(1));
  EXPECT_NEAR(glm::length(middle - parameters.center(2)), 0, 1e-6);
  const auto mean = [](const OracleImage& image) {
    double sum = 0;
    for (const auto& pixel : image.color.pixels) sum += double(pixel[0]);
    return sum / double(image.color.pixels.size());
  };
  NeuralParameters halves = parameters, whole = one_density();
  const std::vector<std::uint32_t> children{0, 1};
  halves.reorder(children);
  const double before = mean(image_of(whole)), after = mean(image_of(halves));
  EXPECT_NEAR(after, before, 0.3 * before);
}

TEST(NeuralStart, FromGaussiansHasTheirPlacesAndOpacity) {
  GaussianParameters gaussians(2, 1);
  Random random(5);
  for (std::size_t i = 0; i < 2; ++i) {
    gaussians.trained(splatting::gaussian_row::x)[i] = float(i);
    for (std::size_t axis = 0; axis < 3; ++axis)
      gaussians.trained(splatting::gaussian_row::scale_x + axis)[i] = std::log(0.1f);
    gaussians.trained(splatting::gaussian_row::rotation_w)[i] = 1;
    gaussians.trained(splatting::gaussian_row::opacity)[i] = i == 0 ? 0 : 30;
    gaussians.trained(splatting::gaussian_row::harmonics + 4)[i] = 0.7f;
    gaussians.activate(i);
  }
  const NeuralParameters densities = densities_from(gaussians.splats(), 2, random);
  ASSERT_EQ(densities.count(), 2u);
  EXPECT_EQ(densities.center(1).x, 1);
  EXPECT_FLOAT_EQ(densities.drawn.row(row::semi_axes)[0], 0.2f);
  EXPECT_FLOAT_EQ(densities.drawn.row(row::harmonics + 4)[0], 0.7f);
  // 1 - exp(-2 offset) is the opacity of a ball; 0.3 of this offset.
  EXPECT_FLOAT_EQ(densities.drawn.row(row::offset)[0], 0.3f * std::log(2.0f) / 2);
  EXPECT_LE(densities.drawn.row(row::offset)[1], max_first_offset);
}

TEST(NeuralTraining, LowersTheLossWithTheSameBitsForAnyNumberOfThreads) {
  EXPECT_LT(
      test::loss_ratio_with_any_threads<NeuralTrainer>(short_run(150), test::views_of_a_disc(), 6),
      0.5);
}

TEST(NeuralTraining, ContinuesFromACheckpoint) {
  NeuralConfig config = short_run(90);
  config.max_splats = 150;
  config.first_splats = 100;
  config.anisotropy_weight = 0.25f;
  EXPECT_EQ(
      test::expect_same_bits_after_checkpoint<NeuralTrainer>(config, test::views_of_a_disc(), 43)
          .config.anisotropy_weight,
      0.25f);
}

/// All densities are dead: the run begins again, at other places.
TEST(NeuralTraining, BeginsAgainWhenAllAreDead) {
  const std::vector<TrainingView> views = test::views_of_a_disc();
  const Region region{.center = {0, 0, 0}, .half_side = 1};
  const NeuralConfig config = short_run(150);
  NeuralState state = NeuralTrainer(config, views, region, 1).state();
  for (std::size_t i = 0; i < state.parameters.count(); ++i)
    state.parameters.trained(row::offset)[i] = -5;  // no optical depth along any ray
  NeuralTrainer trainer(config, views, region, 1, state);
  double first = 0, last = 0;
  while (!trainer.done()) {
    const double loss = trainer.step().loss;
    if (trainer.steps_done() <= 6) first += loss;
    if (trainer.steps_done() > 144) last += loss;
  }
  EXPECT_LT(last, 0.7 * first);
}

}  // namespace neural_training_test
}  // namespace tureen::trainer
