// The cost of a training step on the processor, by stage, and the gain of more threads. Steps with
// one thread and with all threads alternate, so that other programs affect both equally. Only the
// ratios apply to other machines. Prints one stage per line, as JSON.
//
// The soup is a cut-out cloud that learns the images of another one, or with --soup a trained soup
// with its photographs.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/dataset/dataset.hpp"
#include "formats/scene_file.hpp"
#include "scene/lattice.hpp"
#include "tests/support/cutout_cloud.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/initialise.hpp"
#include "trainer/diffsoup/model.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::test {
namespace {

using trainer::Backend;
using trainer::StageTimes;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The times of single steps.
struct Contender {
  std::unique_ptr<Backend> backend;
  std::vector<StageTimes> steps;

  double ms(double StageTimes::*stage) const {
    std::vector<double> values;
    for (const StageTimes& times : steps) values.push_back(times.*stage * 1e3);
    return median(values);
  }
};

struct Stage {
  const char* name;
  double StageTimes::*seconds;
  std::uint64_t StageTimes::*work;  // the number of units of work in its time
  const char* unit;
};

constexpr Stage stages[] = {
    {"visibility", &StageTimes::visibility, &StageTimes::fragments, "fragment"},
    {"shading", &StageTimes::shading, &StageTimes::shaded_pixels, "shaded pixel"},
    {"loss", &StageTimes::loss, &StageTimes::pixels, "pixel"},
    {"backward", &StageTimes::shading_backward, &StageTimes::shaded_pixels, "shaded pixel"},
    {"faces", &StageTimes::faces, &StageTimes::shaded_pixels, "shaded pixel"},
};

/// Images of another cloud, so that there is always something to learn.
std::vector<trainer::TrainingView> images(const Scene& scene, const trainer::Config& config) {
  trainer::TrainingState state;
  state.model = trainer::from_scene(scene, {.min_level = 2, .max_level = 3});
  state.moments.reset_faces(state.model);
  const auto backend = trainer::make_cpu_backend({}, config, 0);
  backend->upload(state);
  std::vector<trainer::TrainingView> views;
  for (const Camera& camera : scene.cameras) {
    trainer::TrainingView& view = views.emplace_back();
    view.camera = camera;
    for (const float value : backend->render(camera))
      view.target.push_back(std::uint8_t(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f));
  }
  return views;
}

struct Options {
  int width = 400, height = 400;  // of the cloud
  int level = 3;                  // the finest of the texture
  std::string soup, dataset;
  double scale = 1;
  int steps = 20;
};

struct Training {
  trainer::Config config;
  std::vector<trainer::TrainingView> views;
  trainer::TrainingState state;
};

Training cloud_training(const Options& options) {
  const CutoutCloudOptions learned{.width = options.width, .height = options.height};
  CutoutCloudOptions shown = learned;
  shown.seed = 2;
  Training training{trainer::preset(trainer::Preset::object), {}, {}};
  std::ranges::fill(training.config.background, 0.0f);
  training.views = images(cutout_cloud(shown), training.config);
  training.state.model = trainer::from_scene(
      cutout_cloud(learned), {.min_level = std::min(2, options.level), .max_level = options.level});
  return training;
}

Training trained_soup(const Options& options) {
  Dataset dataset = read_dataset(options.dataset, {.scale = options.scale});
  const Region region = region_of_interest(dataset);
  Training training{
      trainer::scaled_to(trainer::preset(trainer::Preset::object), region.half_side), {}, {}};
  training.views = trainer::take_training_views(dataset.train, training.config.background);
  training.state.model =
      trainer::from_scene(read_scene(options.soup),
                          {.min_level = std::min(2, options.level), .max_level = options.level});
  return training;
}

int run(const Options& options) {
  Training training = options.soup.empty() ? cloud_training(options) : trained_soup(options);
  auto& [config, views, state] = training;
  state.moments.reset_faces(state.model);
  const int steps = options.steps;

  Contender contenders[2] = {{trainer::make_cpu_backend(views, config, 1), {}},
                             {trainer::make_cpu_backend(views, config, 0), {}}};
  for (Contender& contender : contenders) contender.backend->upload(state);
  // With rates of 0, every step does the same work on the same soup. The first three fill caches.
  for (int step = 1; step <= steps + 3; ++step)
    for (Contender& contender : contenders) {
      contender.backend->step(trainer::batch_of(step, 4, views.size(), 0),
                              {.texture = 0, .mlp = 0, .vertex = 0});
      const StageTimes times = contender.backend->take_times();
      if (step > 3) contender.steps.push_back(times);
    }

  const StageTimes& last = contenders[0].steps.back();
  double sums[2] = {};
  const auto print = [](const char* stage, double one, double all, nlohmann::json row) {
    row.update({{"stage", stage}, {"one_thread_ms", one}, {"all_threads_ms", all}});
    row["speedup"] = one / all;
    std::printf("%s\n", row.dump().c_str());
  };
  for (const Stage& stage : stages) {
    const double one = contenders[0].ms(stage.seconds), all = contenders[1].ms(stage.seconds);
    const double work = double(last.*stage.work);
    sums[0] += one;
    sums[1] += all;
    print(stage.name, one, all,
          {{"work", work}, {"unit", stage.unit}, {"ns_per_unit", one * 1e6 / work}});
  }
  print("all", sums[0], sums[1], {{"work", 1}, {"unit", "step"}, {"ns_per_unit", sums[0] * 1e6}});
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  CLI::App app("Measures the stages of a training step.");
  tureen::test::Options options;
  auto* width = app.add_option("--width", options.width)->check(CLI::PositiveNumber);
  auto* height = app.add_option("--height", options.height)->check(CLI::PositiveNumber);
  app.add_option("--level", options.level)->check(CLI::Range(0, tureen::lattice::max_level));
  app.add_option("--steps", options.steps)->check(CLI::PositiveNumber);
  auto* dataset = app.add_option("--dataset", options.dataset, "photographs of the soup");
  auto* soup = app.add_option("--soup", options.soup, "trained soup");
  soup->needs(dataset)->excludes(width)->excludes(height);
  dataset->needs(soup);
  app.add_option("--scale", options.scale, "of the photographs")
      ->needs(dataset)
      ->check(CLI::Range(0.001, 1.0));
  CLI11_PARSE(app, argc, argv);
  try {
    return tureen::test::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "training_benchmark: %s\n", error.what());
    return 1;
  }
}
