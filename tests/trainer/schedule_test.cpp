// The schedule of a run, on a backend that learns nothing: batches, resampling, and the budget at
// the end.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "tests/trainer/random_model.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/diffsoup/backing.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::trainer {

namespace schedule_test {

/// The error of each face is its index plus 1, and every `unseen`-th face has no pixel.
class BlindBackend : public Backend {
 public:
  explicit BlindBackend(std::size_t unseen) : unseen_(unseen) {}

  std::string description() const override { return "none"; }
  void upload(const TrainingState& state) override { state_ = state; }
  void download(TrainingState& state) const override { state = state_; }
  StepReport step(std::span<const std::uint32_t>, const Rates&) override {
    state_.errors.resize(state_.model.faces());
    std::iota(state_.errors.begin(), state_.errors.end(), 1.0f);
    ++state_.step;
    return {};
  }
  StageTimes take_times() override { return {}; }
  std::vector<std::uint64_t> visible_pixels(std::span<const Camera>) override {
    std::vector<std::uint64_t> pixels;
    for (std::size_t face = 0; face < state_.model.faces(); ++face)
      pixels.push_back(face % unseen_ == unseen_ - 1 ? 0 : face + 1);
    return pixels;
  }
  std::vector<float> render(const Camera&) override { return {}; }

 protected:
  TrainingState state_;

 private:
  std::size_t unseen_;
};

struct Case {
  const char* name;
  Config config;
  std::size_t initial_faces;
  std::size_t unseen = 7;
};

/// Faces of about the size of the image, some smaller than any threshold.
TrainingState first_state(std::size_t faces) {
  TrainingState state;
  state.model = test::random_model(5, {.faces = faces, .min_level = 0, .max_level = 0});
  state.model.origin = {0, 0, -5};
  for (std::size_t i = 0; i < state.model.positions.size(); ++i)
    if (i / 3 % 3) state.model.positions[i] *= 1e-3f;
  state.moments.reset_faces(state.model);
  return state;
}

std::size_t faces_in_the_end(const Case& run) {
  const std::vector<TrainingView> views(
      3, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
  Trainer trainer(run.config, views, std::make_unique<BlindBackend>(run.unseen),
                  first_state(run.initial_faces));
  while (!trainer.done()) trainer.step();
  EXPECT_EQ(trainer.state().model.faces(), trainer.faces()) << run.name;
  EXPECT_EQ(trainer.state().model.max_level, run.config.max_level) << run.name;
  return trainer.faces();
}

TEST(Schedule, EveryEpochShowsEachViewOnceAndNoBatchTwice) {
  for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 8u, 35u})
    for (const int batch : {1, 3, 4, 7}) {
      const int steps_an_epoch = int((count + std::size_t(batch) - 1) / std::size_t(batch));
      for (int epoch = 0; epoch < 3; ++epoch) {
        std::multiset<std::uint32_t> shown;
        for (int step = epoch * steps_an_epoch + 1; step <= (epoch + 1) * steps_an_epoch; ++step) {
          const std::vector<std::uint32_t> views = batch_of(step, batch, count, 3);
          ASSERT_FALSE(views.empty());
          EXPECT_LE(views.size(), std::size_t(batch));
          shown.insert(views.begin(), views.end());
        }
        EXPECT_EQ(shown.size(), count) << "batches of " << batch;
        EXPECT_EQ(std::set(shown.begin(), shown.end()).size(), count) << "batches of " << batch;
      }
    }
}

TEST(Schedule, MeetsTheBudgetExactlyInEveryPreset) {
  for (const Preset kind : {Preset::object, Preset::scene})
    for (const bool compat : {false, true})
      for (const int steps : {1, 7, 60})
        for (const std::size_t initial : {std::size_t(1), std::size_t(50), std::size_t(200)}) {
          Case run{"", compat ? published(kind) : preset(kind), initial};
          run.config.steps = steps;
          run.config.triangles = 50;
          run.config.resample_every = 10;
          run.config.max_level = 2;
          EXPECT_EQ(faces_in_the_end(run), 50u)
              << (kind == Preset::object ? "object" : "scene") << (compat ? ", published" : "")
              << ", " << steps << " steps from " << initial << " faces";
        }
}

TEST(Schedule, KeepsTheBackingLayer) {
  Config config = preset(Preset::scene);
  config.steps = 60;
  config.triangles = 2000;
  config.resample_every = 10;
  config.min_level = config.max_level = 1;
  config.turnover = 0.5f;
  const std::size_t backing = backing_faces(config);
  ASSERT_EQ(backing, 20u);
  TrainingState state = first_state(2000);
  const std::vector<glm::vec3> before(state.model.positions.begin(),
                                      state.model.positions.begin() + 60);
  const std::vector<TrainingView> views(
      3, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
  // Every second face is invisible, also in the backing layer.
  Trainer trainer(config, views, std::make_unique<BlindBackend>(2), std::move(state));
  while (!trainer.done()) trainer.step();
  const std::vector<glm::vec3> after = trainer.state().model.positions;
  EXPECT_EQ(trainer.faces(), 2000u);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin()));
}

TEST(Schedule, MeetsTheBudgetWhateverTheSchedule) {
  Config config;
  config.steps = 40;
  config.triangles = 30;
  config.resample_every = 10;
  Config rare = config, early = config, late = config, none = config, greedy = config, one = config;
  rare.resample_every = 1000;
  early.lift_at = 0;
  late.lift_at = 1;
  none.resample_until = 0;
  greedy.turnover = 0.99f;
  one.triangles = 1;
  for (const Case& run : {Case{"resampled rarely", rare, 30}, Case{"lifted at once", early, 30},
                          Case{"lifted at the end", late, 30}, Case{"never resampled", none, 100},
                          Case{"all renewed", greedy, 30}, Case{"one triangle", one, 30}})
    EXPECT_EQ(faces_in_the_end(run), std::size_t(run.config.triangles)) << run.name;
}

TEST(Schedule, IsMovedByFitsOfTheSteps) {
  const std::vector<TrainingView> views(
      3, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
  Config config = preset(Preset::object);
  config.triangles = 40;
  config.max_level = 3;
  config.minutes = 1;
  // Fits that pass the lift (0.05) and the last resampling (0.95), forwards and back.
  for (const std::vector<std::pair<int, int>>& fits :
       {std::vector<std::pair<int, int>>{{20, 130}, {100, 104}},
        {{3, 2000}, {50, 60}, {55, 400}},
        {{390, 391}},
        {{10, 12}}}) {
    config.steps = 400;
    Trainer trainer(config, views, std::make_unique<BlindBackend>(7), first_state(60));
    auto fit = fits.begin();
    while (!trainer.done()) {
      trainer.step();
      if (fit != fits.end() && trainer.steps_done() == fit->first)
        trainer.set_steps((fit++)->second);
    }
    EXPECT_EQ(trainer.faces(), 40u) << fits.front().first;
    EXPECT_EQ(trainer.state().model.max_level, 3) << fits.front().first;
  }
}

TEST(Schedule, MeetsTheBudgetEvenWhereNothingIsSeen) {
  for (const std::size_t initial : {std::size_t(10), std::size_t(90)}) {
    Config config;
    config.steps = 40;
    config.triangles = 50;
    config.resample_every = 10;
    const std::vector<TrainingView> views(
        3, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
    Trainer trainer(config, views, std::make_unique<BlindBackend>(1), first_state(initial));
    while (!trainer.done()) trainer.step();
    EXPECT_EQ(trainer.faces(), 50u) << initial;
  }
}

TEST(Schedule, PublishedScenesAreSplitBeyondTheBudgetAndPrunedToIt) {
  Case run{"", published(Preset::scene), 50, 7};
  run.config.steps = 60;
  run.config.triangles = 50;
  run.config.resample_every = 10;
  run.config.max_level = 2;
  run.config.split_fraction = 0.02f;  // there is always something to split
  const std::vector<TrainingView> views(
      3, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
  Trainer trainer(run.config, views, std::make_unique<BlindBackend>(run.unseen),
                  first_state(run.initial_faces));
  for (int step = 1; step <= 60; ++step) {
    const std::size_t before = trainer.faces();
    trainer.step();
    const ResampleReport& report = trainer.last_resample();
    if (step == 10) {
      // The model is at the budget, so nothing is pruned, not even unseen faces; long edges are
      // still split.
      EXPECT_EQ(report.unseen + report.pruned, 0u);
      EXPECT_GT(report.split, 10u);
      EXPECT_EQ(trainer.faces(), 50 + report.split);
    }
    if (step == 20) {
      EXPECT_GT(report.pruned, 10u);
      EXPECT_EQ(trainer.faces(), 50 + report.split);
    }
    if (step == 50) {  // the last one only prunes; 57 is rounded down to a multiple of ten
      EXPECT_EQ(report.pruned, before - 50);
      EXPECT_EQ(report.split, 0u);
    }
    if (step >= 50) {
      EXPECT_EQ(trainer.faces(), 50u);
    }
  }
}

/// Shows `seen_once` faces only in the first camera, the others in all cameras.
class NarrowBackend final : public BlindBackend {
 public:
  NarrowBackend(std::size_t seen_once, glm::dmat4 first)
      : BlindBackend(~std::size_t(0)), seen_once_(seen_once), first_(first) {}

  std::vector<std::uint64_t> visible_pixels(std::span<const Camera> cameras) override {
    std::vector<std::uint64_t> pixels = BlindBackend::visible_pixels(cameras);
    bool is_first = false;
    for (const Camera& camera : cameras) is_first |= camera.view_from_world == first_;
    for (std::size_t face = 0; !is_first && face < seen_once_; ++face) pixels[face] = 0;
    return pixels;
  }

 private:
  std::size_t seen_once_;
  glm::dmat4 first_;
};

std::size_t removed_of(const Config& config, std::size_t seen_once, std::size_t images = 40) {
  std::vector<TrainingView> views(
      images, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
  views[0].camera.view_from_world[3].x = 0.125;
  Trainer trainer(config, views,
                  std::make_unique<NarrowBackend>(seen_once, views[0].camera.view_from_world),
                  first_state(50));
  trainer.step();
  return trainer.last_resample().unseen;
}

TEST(Schedule, RemovesFacesThatTooFewImagesShow) {
  Config config;
  config.steps = 20;
  config.triangles = 50;
  config.resample_every = 1;
  for (const auto& [least, removed] : {std::pair(1, 0u), {2, 12u}, {3, 12u}}) {
    config.min_views = least;
    EXPECT_EQ(removed_of(config, 12), removed) << least;
    EXPECT_EQ(removed_of(config, 12, 19), 0u);  // too few images to require two
  }
}

TEST(Schedule, RemovesFacesBeforeTheNearPlane) {
  Config config;
  config.steps = 20;
  config.triangles = 50;
  config.resample_every = 1;
  config.near = 0.01f;
  config.clear_near = true;
  EXPECT_EQ(removed_of(config, 0), 0u);
  config.near = 5.0f;  // the middle of all faces
  const std::size_t removed = removed_of(config, 0);
  EXPECT_GT(removed, 10u);
  EXPECT_LT(removed, 50u);
  config.clear_near = false;
  EXPECT_EQ(removed_of(config, 0), 0u);
}

/// Marks each face with moments: all are the x of its first corner.
class MarkingBackend final : public BlindBackend {
 public:
  using BlindBackend::BlindBackend;
  StepReport step(std::span<const std::uint32_t> views, const Rates& rates) override {
    Moments& moments = state_.moments;
    const std::size_t logits = state_.model.texels() * channels;
    for (std::size_t face = 0; face < state_.model.faces(); ++face) {
      const float mark = state_.model.positions[3 * face].x;
      std::fill_n(moments.first.begin() + std::ptrdiff_t(face * logits), logits, mark);
      std::fill_n(moments.second.begin() + std::ptrdiff_t(face * logits), logits, mark);
      std::fill_n(moments.vertex_first.begin() + std::ptrdiff_t(3 * face), 3, glm::vec3(mark));
      std::fill_n(moments.vertex_second.begin() + std::ptrdiff_t(3 * face), 3, mark);
      moments.steps[face] = 70;
    }
    moments.mlp_steps = 70;
    return BlindBackend::step(views, rates);
  }
};

TEST(Schedule, MomentsFollowTheirFacesThroughAResampling) {
  Config config;
  config.steps = 100;
  config.triangles = 50;
  config.resample_every = 10;
  for (const bool reset : {false, true}) {
    config.reset_moments = reset;
    const std::vector<TrainingView> views(
        3, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
    Trainer trainer(config, views, std::make_unique<MarkingBackend>(7), first_state(50));
    while (trainer.steps_done() < config.resample_every) trainer.step();
    ASSERT_GT(trainer.last_resample().unseen, 0u);
    const TrainingState state = trainer.state();
    const Moments& moments = state.moments;
    const std::size_t logits = state.model.texels() * channels;
    std::size_t followed = 0, fresh = 0;
    for (std::size_t face = 0; face < state.model.faces(); ++face) {
      const bool is_fresh = moments.steps[face] == 0;
      ++(is_fresh ? fresh : followed);
      const float mark = is_fresh ? 0 : state.model.positions[3 * face].x;
      for (std::size_t i = face * logits; i < (face + 1) * logits; ++i) {
        ASSERT_EQ(moments.first[i], mark) << face;
        ASSERT_EQ(moments.second[i], mark) << face;
      }
      for (std::size_t i = 3 * face; i < 3 * (face + 1); ++i) {
        ASSERT_EQ(moments.vertex_first[i], glm::vec3(mark)) << face;
        ASSERT_EQ(moments.vertex_second[i], mark) << face;
      }
    }
    EXPECT_EQ(moments.mlp_steps, 70u);
    EXPECT_GT(fresh, 0u);
    if (reset) {
      EXPECT_EQ(followed, 0u);
    } else {
      EXPECT_GT(followed, 10u) << "too few to prove anything";
    }
  }
}

TEST(Schedule, FacesStayAfterTheLastResampling) {
  // 0.95f is below 0.95: with 200 steps the last resampling must be at step 190, not 180.
  Config config;
  config.steps = 200;
  config.triangles = 50;
  config.resample_every = 10;
  const std::vector<TrainingView> views(
      3, {.camera = test::axis_camera(64, 48, 60), .target = {}, .ignored = {}});
  Trainer trainer(config, views, std::make_unique<BlindBackend>(7), first_state(50));
  int last = 0;
  while (!trainer.done()) {
    const std::vector<glm::vec3> before = trainer.state().model.positions;
    trainer.step();
    if (trainer.state().model.positions != before) last = trainer.steps_done();
  }
  EXPECT_EQ(last, 190);
}

}  // namespace schedule_test

}  // namespace tureen::trainer
