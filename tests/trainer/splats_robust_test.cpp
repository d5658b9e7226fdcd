// Training of Gaussians in extreme cases: few splats, one photograph, images without detail, splats
// that no image shows.
#include <gtest/gtest.h>

#include <cmath>

#include "image/metrics.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"

namespace tureen::trainer {
namespace splats_robust_test {

namespace row = splatting::gaussian_row;

constexpr int width = 40, height = 33;
constexpr Region region{.center = {0, 0, 0}, .half_side = 1};

/// Views from around, or outwards from the centre. `color(x, y)`: of a channel, from 0 to 255.
template <class ColorOf>
std::vector<TrainingView> views_of(int count, bool outwards, const ColorOf& color) {
  std::vector<TrainingView> views;
  for (int k = 0; k < count; ++k) {
    TrainingView& view = views.emplace_back();
    const double turn = k * 1.05;
    const glm::dvec3 away{std::cos(turn), std::sin(turn), 0.25};
    view.camera = look_at(outwards ? glm::dvec3(0) : 4.0 * away, outwards ? away : glm::dvec3(0),
                          {0, 0, 1}, 0.6, width, height);
    for (int i = 0; i < 3 * width * height; ++i)
      view.target.push_back(std::uint8_t(color(i % width, i / width % height)));
  }
  return views;
}

int disc(int x, int y) { return (x - 20) * (x - 20) + (y - 16) * (y - 16) < 80 ? 180 : 0; }

GaussianConfig short_run(int steps) {
  GaussianConfig config;
  config.steps = steps;
  config.max_splats = 300;
  config.first_splats = 200;
  config.densify_every = 20;
  for (float& channel : config.background) channel = 0;
  return config;
}

/// Trains to the end; the mean PSNR of the views.
double psnr_after(GaussianTrainer& trainer, std::span<const TrainingView> views) {
  while (!trainer.done()) {
    const SplatStepReport report = trainer.step();
    EXPECT_EQ(report.quarantined, 0u);
    EXPECT_TRUE(std::isfinite(report.loss));
  }
  double squared = 0;
  for (const TrainingView& view : views) {
    const std::vector<float> planes = trainer.render(view.camera);
    for (std::size_t i = 0; i < planes.size(); ++i)
      squared += std::pow(double(planes[i]) - view.target[i] / 255.0, 2) / double(planes.size());
  }
  return psnr_from_mse(squared / double(views.size()));
}

double psnr_of(const GaussianConfig& config, std::span<const TrainingView> views) {
  GaussianTrainer trainer(config, views, region, 1);
  return psnr_after(trainer, views);
}

// Black images have 10 dB for the disc, 5 dB for the wall and the sky. Measured values exceed the
// bounds below by at least 2 dB.

TEST(SplatsRobust, TrainsFromOnePhotograph) {
  const auto views = views_of(1, false, disc);
  EXPECT_GT(psnr_of(short_run(200), views), 20);
}

TEST(SplatsRobust, TrainsFromOneSplat) {
  const auto views = views_of(6, false, disc);
  GaussianConfig config = short_run(300);
  config.first_splats = 1;
  EXPECT_GT(psnr_of(config, views), 17);
}

TEST(SplatsRobust, TrainsAWall) {
  const auto views = views_of(6, false, [](int, int) { return 140; });
  EXPECT_GT(psnr_of(short_run(300), views), 14);
}

TEST(SplatsRobust, TrainsASkyAroundTheCameras) {
  const auto views = views_of(6, true, [](int, int y) { return 100 + 3 * y; });
  EXPECT_GT(psnr_of(short_run(300), views), 14);
}

TEST(SplatsRobust, BeginsAgainWhenAllSplatsAreDead) {
  const auto views = views_of(6, false, disc);
  const GaussianConfig config = short_run(300);
  GaussianState state = GaussianTrainer(config, views, region, 1).state();
  for (std::size_t i = 0; i < state.parameters.count(); ++i) {
    state.parameters.trained(row::opacity)[i] = -12;  // far below the smallest alpha
    state.parameters.activate(i);
  }
  GaussianTrainer trainer(config, views, region, 1, state);
  EXPECT_GT(psnr_after(trainer, views), 20);
}

/// Longer runs do not become unstable.
TEST(SplatsRobust, MoreStepsAreNotWorse) {
  const auto views = views_of(6, false, disc);
  EXPECT_GT(psnr_of(short_run(800), views), psnr_of(short_run(200), views) - 0.1);
}

}  // namespace splats_robust_test
}  // namespace tureen::trainer
