// Small training views for tests of splats, and runs whose bits depend neither on the number of
// threads nor on an interruption.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "base/existing_path.hpp"
#include "trainer/splats/splat_trainer.hpp"

namespace tureen::trainer::test {

/// Views of a bright disc on black, from around.
inline std::vector<TrainingView> views_of_a_disc() {
  std::vector<TrainingView> views;
  for (int k = 0; k < 6; ++k) {
    TrainingView& view = views.emplace_back();
    const double turn = k * 1.05;
    view.camera =
        look_at({4 * std::cos(turn), 4 * std::sin(turn), 1}, {0, 0, 0}, {0, 0, 1}, 0.6, 40, 33);
    for (int i = 0; i < 3 * 40 * 33; ++i) {
      const int x = i % 40 - 20, y = i / 40 % 33 - 16;
      view.target.push_back(x * x + y * y < 80 ? std::uint8_t(120 + 40 * (i / (40 * 33))) : 0);
    }
  }
  return views;
}

template <class Values>
void expect_same_bits(const Values& a, const Values& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(*a.data())), 0);
}

/// Trains 300 splats with several numbers of threads. Returns the loss of the last `few` steps over
/// that of the first ones.
template <class Trainer>
double loss_ratio_with_any_threads(const typename Trainer::Config& config,
                                   const std::vector<TrainingView>& views, int few) {
  double ratio = 0;
  std::vector<float> images[3];
  const int threads[] = {1, 2, 5};
  for (int run = 0; run < 3; ++run) {
    Trainer trainer(config, views, {.center = {0, 0, 0}, .half_side = 1}, threads[run]);
    double first = 0, last = 0;
    std::size_t quarantined = 0;
    while (!trainer.done()) {
      const SplatStepReport report = trainer.step();
      if (trainer.steps_done() <= few) first += report.loss;
      if (trainer.steps_done() > config.steps - few) last += report.loss;
      quarantined += report.quarantined;
    }
    ratio = last / first;
    EXPECT_EQ(quarantined, 0u);
    EXPECT_EQ(trainer.parameters().count(), 300u);
    images[run] = trainer.render(views[0].camera);
  }
  for (const int run : {1, 2}) expect_same_bits(images[0], images[run]);
  return ratio;
}

/// Trains with a checkpoint after `steps`, and again from there on with another number of threads.
/// Returns the checkpoint as it was read.
template <class Trainer>
auto expect_same_bits_after_checkpoint(const typename Trainer::Config& config,
                                       const std::vector<TrainingView>& views, int steps) {
  using Checkpoint = SplatCheckpoint<typename Trainer::Config, typename Trainer::Parameters>;
  const Region region{.center = {0, 0, 0}, .half_side = 1};
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const auto path = std::filesystem::path(testing::TempDir()) /
                    (std::string("tureen_") + info->name() + ".checkpoint");
  Trainer whole(config, views, region, 2);
  while (whole.steps_done() < steps) whole.step();
  const std::vector<ViewFingerprint> fingerprints(views.size(), {"r_0", 40, 33, 1u, 2u});
  write_checkpoint(path,
                   Checkpoint{.config = config, .views = fingerprints, .state = whole.state()});
  while (!whole.done()) whole.step();
  const auto stored = read_splat_checkpoint<Checkpoint>(open_existing(path));
  std::filesystem::remove(path);
  Trainer second(stored.config, views, region, 1, stored.state);
  while (!second.done()) second.step();
  expect_same_bits(whole.parameters().drawn.values(), second.parameters().drawn.values());
  return stored;
}

}  // namespace tureen::trainer::test
