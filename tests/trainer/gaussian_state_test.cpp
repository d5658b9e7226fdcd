// Checkpoints of Gaussians: a run continues with the same bits after any step.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>

#include "base/error.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"
#include "tests/trainer/splat_runs.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/splat_state.hpp"

namespace tureen::trainer {
namespace gaussian_state_test {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

constexpr Region region{.center = {0, 0, 0}, .half_side = 1};

GaussianConfig short_run() {
  return {{.steps = 60,
           .max_splats = 350,
           .first_splats = 150,
           .densify_every = 20,
           .background = {0, 0, 0}}};
}

std::vector<ViewFingerprint> fingerprints(std::size_t count) {
  return std::vector<ViewFingerprint>(count, {"r_0", 40, 33, 1u, 2u});
}

Bytes written(const GaussianCheckpoint& checkpoint) {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path path =
      fs::path(testing::TempDir()) / (std::string("tureen_gaussians_") + info->name());
  write_checkpoint(path, checkpoint);
  Bytes bytes = Input::open(path).read_rest();
  fs::remove(path);
  return bytes;
}

GaussianCheckpoint read(std::span<const std::byte> bytes) {
  return read_splat_checkpoint<GaussianCheckpoint>(Input::memory("run.checkpoint", bytes));
}

TEST(GaussianCheckpoint, AnyStepContinuesWithTheSameBits) {
  const std::vector<TrainingView> views = test::views_of_a_disc();
  const GaussianConfig config = short_run();
  std::vector<Bytes> checkpoints;
  GaussianTrainer whole(config, views, region, 2);
  const auto checkpoint = [&](const GaussianTrainer& trainer) {
    return written(
        {.config = config, .views = fingerprints(views.size()), .state = trainer.state()});
  };
  std::size_t densified = 0;
  while (!whole.done()) {
    checkpoints.push_back(checkpoint(whole));
    const SplatStepReport report = whole.step();
    densified += report.split > 0;
  }
  EXPECT_EQ(densified, 2u);  // after steps 20 and 40
  const Bytes end = checkpoint(whole);
  // At the start, within an epoch, and before and right after each densification.
  for (const std::size_t step : {0u, 1u, 7u, 19u, 20u, 21u, 40u, 59u}) {
    GaussianCheckpoint stored = read(checkpoints[step]);
    EXPECT_EQ(stored.state.step, int(step));
    EXPECT_EQ(written(stored), checkpoints[step]);
    GaussianTrainer second(stored.config, views, region, 1, std::move(stored.state));
    while (!second.done()) second.step();
    EXPECT_EQ(checkpoint(second), end) << "after step " << step;
  }
}

GaussianCheckpoint small() {
  const std::vector<TrainingView> views = test::views_of_a_disc();
  GaussianConfig config = short_run();
  config.degree = 0;
  config.first_splats = 3;
  GaussianTrainer trainer(config, views, region, 1);
  trainer.step();
  GaussianCheckpoint result{.config = config,
                            .views = fingerprints(views.size()),
                            .seconds = 2.5,
                            .state = trainer.state()};
  result.state.non_finite = 4;
  return result;
}

TEST(GaussianCheckpoint, KeepsTheRun) {
  const GaussianCheckpoint a = small(), b = read(written(a));
  EXPECT_FALSE(splat_config_difference(a.config, b.config));
  EXPECT_FALSE(difference(a.views, b.views));
  EXPECT_EQ(a.seconds, b.seconds);
  EXPECT_EQ(b.state.non_finite, 4u);
  EXPECT_EQ(a.state.epoch, b.state.epoch);
}

TEST(GaussianCheckpoint, SurvivesTruncationAndDamage) {
  const Bytes bytes = written(small());
  const auto use = [](std::span<const std::byte> part) { read(part); };
  const auto cut = tureen::test::survive_truncation(bytes, use);
  EXPECT_EQ(cut.read, 0u);
  EXPECT_EQ(cut.refused, bytes.size());
  EXPECT_EQ(tureen::test::survive_damage(bytes, use).read, 0u);
}

TEST(GaussianCheckpoint, RejectsInconsistentStates) {
  const auto refused = [](const std::function<void(GaussianCheckpoint&)>& change,
                          const char* reason) {
    GaussianCheckpoint checkpoint = small();
    change(checkpoint);
    EXPECT_THAT(tureen::test::error_of([&] { read(written(checkpoint)); }),
                tureen::test::ErrorIn("run.checkpoint", reason));
  };
  refused([](auto& c) { c.state.step = 61; }, "61");
  refused([](auto& c) { c.state.step = -1; }, "-1");
  refused([](auto& c) { c.state.epoch.push_back(99); }, "epoch");
  refused([](auto& c) { c.views.clear(); }, "epoch");
  refused([](auto& c) { c.views[0].width = 0; }, "0 x 33");
  refused([](auto& c) { c.seconds = std::numeric_limits<double>::quiet_NaN(); }, "time");
  refused([](auto& c) { c.state.memory.moments.pop_back(); }, "match");
  refused([](auto& c) { c.config.degree = 1; }, "degree");
  refused([](auto& c) { c.config.steps = 0; }, "steps");
  // Splats that are not finite are a part of a run: the next densification replaces them.
  GaussianCheckpoint kept = small();
  kept.state.parameters.drawn.row(0)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NO_THROW(read(written(kept)));
}

}  // namespace gaussian_state_test
}  // namespace tureen::trainer
