// A small training from end to end: 300 steps turn photographs of the example's still life, 64 x 64
// pixels, into a soup of 500 triangles. Takes seconds.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <numeric>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/platform/scratch_file.hpp"
#include "examples/photograph.hpp"
#include "examples/still_life.hpp"
#include "formats/scene_file.hpp"
#include "image/metrics.hpp"
#include "image/quantise.hpp"
#include "image/specks.hpp"
#include "jobs/training/first_gaussians.hpp"
#include "trainer/common/training_log.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/diffsoup/initialise.hpp"
#include "trainer/diffsoup/texture_level.hpp"
#include "trainer/diffsoup/trainer.hpp"
#include "trainer/diffsoup/training.hpp"

namespace tureen::trainer {
namespace smoke_test {

namespace fs = std::filesystem;

constexpr int size = 64, steps = 300, triangles = 500;

std::vector<Photograph> photographs(const example::Studio& studio, int count, double turn) {
  std::vector<Photograph> result;
  for (const Camera& camera : example::example_cameras(count, size, turn))
    result.push_back({camera, studio.photograph(camera, 2)});
  return result;
}

/// 24 training photographs and 6 test photographs.
const Dataset& still_life() {
  static const Dataset dataset = [] {
    const example::Studio studio(example::still_life(), example::draft_light);
    Dataset made;
    made.train = photographs(studio, 24, 0);
    made.test = photographs(studio, 6, 0.5);
    made.has_alpha = true;
    return made;
  }();
  return dataset;
}

/// The same photographs in front of a wall: no pixel shows the background.
Dataset still_life_before_a_wall() {
  Dataset dataset = still_life();
  dataset.has_alpha = false;
  for (std::vector<Photograph>* photographs : {&dataset.train, &dataset.test})
    for (Photograph& photograph : *photographs) {
      ImageF image = composited(to_float(photograph.image()), {0.6f, 0.65f, 0.7f});
      for (glm::vec4& pixel : image.pixels) pixel.a = 1;
      photograph.image = quantised(image);
    }
  return dataset;
}

Config smoke_config() {
  Config config = preset(Preset::object);
  config.steps = steps;
  config.triangles = triangles;
  config.initial_triangles = triangles;
  config.max_level = 2;
  config.resample_every = 50;
  config.seed = 7;
  // With so few steps, the rates must be large.
  config.texture_rate = 0.2f;
  config.vertex_rate = 0.04f;
  return scaled_to(config, region_of_interest(still_life()).half_side);
}

TrainingState first_state(const Config& config) {
  TrainingState state;
  state.model = initial_model(still_life(), config);
  state.moments.reset_faces(state.model);
  return state;
}

/// A run with a copy of the views.
struct TrainingRun {
  TrainingRun(const Config& config, int threads, const TrainingState& state)
      : views([&] {
          std::vector<Photograph> train = still_life().train;
          return take_training_views(train, config.background);
        }()),
        trainer(config, views, make_cpu_backend(views, config, threads), state) {}

  void train_until(int step) {
    while (trainer.steps_done() < step) non_finite += trainer.step().non_finite;
  }

  std::vector<TrainingView> views;
  Trainer trainer;
  std::uint64_t non_finite = 0;
};

/// PSNR of the test views, drawn by the trainer in 8 bits per channel.
double test_psnr(TrainingRun& run, const Config& config) {
  double sum = 0;
  for (const Photograph& photograph : still_life().test) {
    const TrainingView truth = training_view(photograph, config.background);
    const std::vector<float> drawn = run.trainer.backend().render(photograph.camera);
    double squared = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const double d = (int(quantised_unit(drawn[i])) - int(truth.target[i])) / 255.0;
      squared += d * d;
    }
    sum += psnr_from_mse(squared / double(drawn.size()));
  }
  return sum / double(still_life().test.size());
}

/// Fractions of the pixels of the test views.
struct Defects {
  double holes = 0, specks = 0;
};

Defects defects(const TrainingState& state, Config config, const Dataset& dataset) {
  // A pixel that shows the background is white in one rendering and black in the other.
  std::vector<std::unique_ptr<Backend>> backends;
  for (const float background : {0.0f, 1.0f}) {
    std::ranges::fill(config.background, background);
    backends.push_back(make_cpu_backend({}, config, 2));
    backends.back()->upload(state);
  }
  Defects result;
  for (const Photograph& photograph : dataset.test) {
    const std::vector<float> on_black = backends[0]->render(photograph.camera);
    const std::vector<float> on_white = backends[1]->render(photograph.camera);
    const std::size_t pixels = on_black.size() / 3;
    const TrainingView target = training_view(photograph, std::array{1.0f, 1.0f, 1.0f});
    const Image8 alpha = photograph.image();
    ImageF rendered(size, size), truth(size, size);
    for (std::size_t i = 0; i < pixels; ++i)
      for (int c = 0; c < 4; ++c) {
        const std::size_t at = std::size_t(c) * pixels + i;
        rendered.pixels[i][c] = c < 3 ? on_white[at] : 1 - (on_white[i] - on_black[i]);
        truth.pixels[i][c] = c < 3 ? target.target[at] / 255.0f : alpha.pixels[i].a / 255.0f;
      }
    const auto mean = [&](const std::vector<float>& map) {
      return std::reduce(map.begin(), map.end(), 0.0) / double(pixels * dataset.test.size());
    };
    result.holes += mean(hole_map(truth, rendered));
    result.specks += mean(speck_map(truth, rendered));
  }
  return result;
}

/// A name that includes the running test's, because others may run at the same time.
fs::path temporary(const std::string& extension) {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  return fs::path(testing::TempDir()) / ("tureen_smoke_" + std::string(info->name()) + extension);
}

/// The bytes of the soup's glb file.
std::vector<std::byte> file_of(const TrainingState& state) {
  const fs::path path = temporary(".glb");
  write_scene(to_scene(state.model), path);
  std::vector<std::byte> bytes = Input::open(path).read_rest();
  fs::remove(path);
  return bytes;
}

TEST(SmokeTraining, LearnsTheStillLife) {
  const Config config = smoke_config();
  TrainingRun run(config, 2, first_state(config));
  const double before = test_psnr(run, config);
  run.train_until(steps);
  const double after = test_psnr(run, config);
  RecordProperty("test_psnr_db", std::to_string(after));
  std::printf("test PSNR %.2f dB, %.2f dB before training\n", after, before);
  EXPECT_EQ(run.trainer.faces(), std::size_t(triangles));
  EXPECT_EQ(run.non_finite, 0u);
  // 22.9 dB when written; six seeds gave 22.5 to 23.3 dB. Other processors round differently, which
  // is like another seed. The margin is one decibel.
  EXPECT_GE(after, 21.5);
  const Defects found = defects(run.trainer.state(), config, still_life());
  std::printf("holes %.1e, specks %.1e\n", found.holes, found.specks);
  // Six seeds gave 0.9e-3 to 1.8e-3 and 9.2e-3 to 1.1e-2; the margins are half of the largest.
  EXPECT_LE(found.holes, 2.7e-3);
  EXPECT_LE(found.specks, 1.7e-2);
}

TEST(ThoroughSmokeTraining, ABackingLayerLeavesNoHoles) {
  Config config = preset(Preset::scene);
  config.steps = steps;
  config.triangles = config.initial_triangles = 2000;  // the fewest with a backing layer, of 20
  config.resample_every = 50;
  config.texture_rate = 0.2f;
  config.vertex_rate = 0.04f;
  Defects with, without;
  for (Defects* found : {&without, &with}) {
    config.backing_triangles = found == &with ? 20 : 0;
    Dataset dataset = still_life_before_a_wall();
    TrainingRequest request;
    request.config = config;
    request.run.session.checkpoint = temporary(".checkpoint");
    request.run.session.log = temporary(".jsonl");
    *found = defects(train(dataset, std::move(request)).state, config, dataset);
    fs::remove(temporary(".jsonl"));
    std::printf("holes %.1e, specks %.1e\n", found->holes, found->specks);
  }
  // The backing layer is closed. Six seeds gave 1.0e-2 to 2.0e-2 holes without it; specks fell from
  // 4.3e-2 .. 5.5e-2 to 1.4e-2 .. 1.7e-2. The margins are half of these bounds.
  EXPECT_EQ(with.holes, 0);
  EXPECT_GT(without.holes, 5e-3);
  EXPECT_LE(with.specks, 2.5e-2);
}

TEST(SmokeTraining, IsTheSameFromPhotographsInAFile) {
  const Config config = smoke_config();
  TrainingRun in_memory(config, 2, first_state(config)), in_file(config, 2, first_state(config));
  const auto file = std::make_shared<ScratchFile>();
  for (TrainingView& view : in_file.views) store(view, file);
  for (TrainingRun* run : {&in_memory, &in_file}) run->train_until(20);
  EXPECT_EQ(file_of(in_memory.trainer.state()), file_of(in_file.trainer.state()));
}

TEST(SmokeTraining, BeginsBetterOnGaussians) {
  Config config = smoke_config();
  config.steps = 40;  // more end at what so few triangles can show
  const auto psnr_after = [](const Config& each) {
    Dataset dataset = still_life();
    TrainingRequest request;
    request.config = each;
    request.run.session.checkpoint = temporary(".checkpoint");
    request.run.session.log = temporary(".jsonl");
    double reached = 0;
    const auto progress = [&reached](double fraction) {
      EXPECT_GE(fraction, reached);
      reached = fraction;
    };
    request.first_scene = [&](const Config& settled, const Region& region) {
      return begins_with_gaussians(settled, dataset)
                 ? std::optional(first_gaussians(dataset, settled, region, 0, progress))
                 : std::nullopt;
    };
    const TrainingResult result = train(dataset, std::move(request));
    fs::remove(temporary(".jsonl"));
    EXPECT_EQ(reached > 0, each.gaussian_steps > 0);
    return result.run.test_psnr_db.value();
  };
  const double on_gaussians = psnr_after(config);
  config.gaussian_steps = 0;
  const double at_random = psnr_after(config);
  std::printf("test PSNR %.2f dB on Gaussians, %.2f dB at random points\n", on_gaussians,
              at_random);
  // Three seeds gave 3.0 to 3.8 dB; the margin is half of the smallest.
  EXPECT_GT(on_gaussians, at_random + 1.5);
}

TEST(SmokeTraining, BeginsOnGaussiansIfItMayAndHasNoPoints) {
  Dataset dataset;
  Config config = preset(Preset::object);
  EXPECT_TRUE(begins_with_gaussians(config, dataset));
  EXPECT_FALSE(begins_with_gaussians(published(Preset::object), dataset));
  for (const Initialisation other :
       {Initialisation::random, Initialisation::points, Initialisation::mesh}) {
    config.initialisation = other;
    EXPECT_FALSE(begins_with_gaussians(config, dataset));
  }
  config.initialisation = Initialisation::automatic;
  dataset.points.push_back({});
  EXPECT_FALSE(begins_with_gaussians(config, dataset));
}

TEST(SmokeTraining, ChoosesTheLevel) {
  Dataset dataset = still_life();
  TrainingRequest request;
  request.config = smoke_config();
  request.config.steps = 10;
  request.config.triangles = 20;
  request.config.max_level = automatic_level;
  request.run.session.checkpoint = temporary(".checkpoint");
  request.run.session.log = temporary(".jsonl");
  const int expected = fitting_level(dataset, 20);
  EXPECT_GT(expected, 3);  // not the lowest, which more triangles have
  EXPECT_EQ(train(dataset, std::move(request)).state.model.max_level, expected);
  fs::remove(temporary(".jsonl"));
}

TEST(SmokeTraining, HasTheSameGaussiansWithAnyNumberOfThreads) {
  Config config = smoke_config();
  config.gaussian_steps = 60;
  const Region region = region_of_interest(still_life());
  const Scene one = first_gaussians(still_life(), config, region, 1, {}),
              two = first_gaussians(still_life(), config, region, 2, {});
  const auto gaussians = [](const Scene& scene) {
    return std::get<Gaussians>(std::get<Splats>(only_layer(scene).primitives).kernel);
  };
  const Gaussians a = gaussians(one), b = gaussians(two);
  EXPECT_FALSE(a.centers.empty());
  EXPECT_EQ(a.centers, b.centers);
  EXPECT_EQ(a.scales, b.scales);
  EXPECT_EQ(a.rotations, b.rotations);
  EXPECT_EQ(a.opacity, b.opacity);
}

/// Ten epochs and two resamplings.
Config brief_config() {
  Config config = smoke_config();
  config.steps = 60;
  config.resample_every = 25;
  return config;
}

/// The end of that run on two threads.
const TrainingState& after_brief_run() {
  static const TrainingState state = [] {
    const Config config = brief_config();
    TrainingRun run(config, 2, first_state(config));
    run.train_until(config.steps);
    return run.trainer.state();
  }();
  return state;
}

TEST(SmokeTraining, HasTheSameBytesWithAnyNumberOfThreads) {
  const Config config = brief_config();
  TrainingRun one(config, 1, first_state(config));
  one.train_until(config.steps);
  EXPECT_EQ(file_of(one.trainer.state()), file_of(after_brief_run()));
}

TEST(SmokeTraining, GoesOnFromACheckpointAsIfItHadNeverStopped) {
  const Config config = brief_config();
  const fs::path path = temporary(".checkpoint");
  // Stops between two resamplings, and between two epochs.
  constexpr int stop = 33;
  {
    TrainingRun first(config, 2, first_state(config));
    first.train_until(stop);
    write_checkpoint(path, {.config = config,
                            .views = fingerprint(still_life().train),
                            .seconds = 1.0,
                            .state = first.trainer.state()});
  }
  const Checkpoint checkpoint = read_checkpoint(open_existing(path));
  fs::remove(path);
  ASSERT_FALSE(difference(config, checkpoint.config)) << *difference(config, checkpoint.config);
  EXPECT_EQ(checkpoint.state.step, stop);
  TrainingRun second(config, 1, checkpoint.state);
  second.train_until(config.steps);
  const TrainingState &a = after_brief_run(), b = second.trainer.state();
  EXPECT_EQ(a.model.positions, b.model.positions);
  EXPECT_EQ(a.model.logits, b.model.logits);
  EXPECT_EQ(a.moments.second, b.moments.second);
  EXPECT_EQ(a.baseline, b.baseline);
  EXPECT_EQ(a.errors, b.errors);
  EXPECT_EQ(file_of(a), file_of(b));
}

/// A whole run with its files, as a program without our command line starts one.
TrainingRequest short_run() {
  TrainingRequest request;
  request.config = smoke_config();
  request.config.steps = 20;
  request.run.name = "still life";
  request.run.session.checkpoint = temporary(".checkpoint");
  request.run.session.log = temporary(".jsonl");
  return request;
}

TEST(SmokeTraining, RunsWithoutTheCommandLine) {
  Dataset dataset = still_life();
  TrainingRequest request = short_run();
  const fs::path log = request.run.session.log;
  std::vector<std::string> calls;
  int last_step = 0;
  Scene evaluated;
  request.begun = [&](const SoupStart&) { calls.push_back("begun"); };
  request.run.session.progress = [&](const SessionStatus& now) { last_step = now.step; };
  request.run.finished = [&](const Scene&) { calls.push_back("finished"); };
  request.run.evaluate = [&](const Scene& scene) {
    calls.push_back("evaluate");
    evaluated = scene;
  };
  const TrainingResult result = train(dataset, std::move(request));
  EXPECT_EQ(calls, (std::vector<std::string>{"begun", "finished", "evaluate"}));
  EXPECT_EQ(last_step, 19);
  EXPECT_EQ(result.state.step, 20);
  EXPECT_GT(result.run.test_psnr_db.value(), 0);
  EXPECT_EQ(evaluated.info.name, "still life");
  EXPECT_EQ(evaluated.cameras.size(), still_life().train.size());
  EXPECT_EQ(only_soup(evaluated).triangles.size(), result.state.model.faces());
  EXPECT_FALSE(read_training_log(log).empty());
  fs::remove(log);
}

TEST(SmokeTraining, KeepsACheckpointIfTheSceneCannotBeStored) {
  Dataset dataset = still_life();
  TrainingRequest request = short_run();
  const fs::path checkpoint = request.run.session.checkpoint, log = request.run.session.log;
  request.run.finished = [](const Scene&) { throw OutputError({}, "no space"); };
  request.run.evaluate = [](const Scene&) { FAIL() << "there is no stored scene"; };
  EXPECT_THROW(train(dataset, std::move(request)), OutputError);
  EXPECT_EQ(read_checkpoint(open_existing(checkpoint)).state.step, 20);
  fs::remove(checkpoint);
  fs::remove(log);
}

}  // namespace smoke_test
}  // namespace tureen::trainer
