// Trains Gaussians on a dataset, on one core, and prints the PSNR of held-out views and the time of
// each stage against seconds of processor time in steps. Prints JSON lines.
//
//   train_gaussians DATASET SCALE [NAME=VALUE]..
//
// Names: steps, splats, first, degree, seed, growth, half (GaussianConfig); marks, the number of
// lines; threads; held_out=1: leaves every eighth training view out, and measures these.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "formats/dataset/dataset.hpp"
#include "image/metrics.hpp"
#include "trainer/splats/gaussian_method.hpp"

namespace tureen::test {
namespace {

using namespace trainer;

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

double mean_psnr(GaussianTrainer& trainer, const std::vector<TrainingView>& views) {
  double sum = 0;
  for (const TrainingView& view : views) {
    const std::vector<float> image = trainer.render(view.camera);
    double squared = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
      const double value = std::round(255 * std::clamp(double(image[i]), 0.0, 1.0));
      squared += std::pow((value - view.target[i]) / 255, 2);
    }
    sum += psnr_from_mse(squared / double(image.size()));
  }
  return sum / double(views.size());
}

int run(int argc, char** argv) {
  GaussianConfig config;
  std::map<std::string, double> values;
  for (int i = 3; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t at = word.find('=');
    values[word.substr(0, at)] = std::atof(word.substr(at + 1).c_str());
  }
  const auto value = [&](const char* name, double otherwise) {
    const auto found = values.extract(name);
    return found ? found.mapped() : otherwise;
  };
  config.steps = int(value("steps", config.steps));
  config.max_splats = std::size_t(value("splats", double(config.max_splats)));
  config.first_splats = std::size_t(value("first", double(config.first_splats)));
  config.degree = int(value("degree", config.degree));
  config.seed = std::uint64_t(value("seed", 0));
  config.growth = value("growth", config.growth);
  config.half_size_until = value("half", config.half_size_until);
  const int marks = int(value("marks", 10)), threads = int(value("threads", 1));
  const bool held_out = value("held_out", 0) != 0;
  if (!values.empty()) throw std::runtime_error("unknown name: " + values.begin()->first);
  Dataset dataset = read_dataset(argv[1], {.scale = std::atof(argv[2])});
  const Region region = region_of_interest(dataset);
  const std::span<const float, 3> background(config.background);
  if (held_out) {
    dataset.test.clear();
    std::vector<Photograph> rest;
    for (std::size_t i = 0; i < dataset.train.size(); ++i)
      (i % 8 == 0 ? dataset.test : rest).push_back(std::move(dataset.train[i]));
    dataset.train = std::move(rest);
  }
  const std::vector<TrainingView> train = take_training_views(dataset.train, background);
  const std::vector<TrainingView> test = take_training_views(dataset.test, background);
  GaussianTrainer trainer(config, train, region, threads);
  double seconds = 0, loss = 0;
  std::size_t quarantined = 0, dead = 0;
  while (!trainer.done()) {
    const double start = processor_seconds();
    const SplatStepReport report = trainer.step();
    seconds += processor_seconds() - start;
    loss += report.loss;
    quarantined += report.quarantined;
    dead += report.dead;
    if (trainer.steps_done() * marks / config.steps ==
        (trainer.steps_done() - 1) * marks / config.steps)
      continue;
    const SplatTimes times = std::exchange(trainer.times(), {});
    const double steps = double(times.steps);
    const auto ms = [&](double of) { return std::round(1e5 * of / steps) / 100; };
    const nlohmann::ordered_json line = {
        {"step", trainer.steps_done()},
        {"seconds", std::round(10 * seconds) / 10},
        {"psnr_db", std::round(100 * mean_psnr(trainer, test)) / 100},
        {"splats", trainer.parameters().count()},
        {"loss", loss / steps},
        {"dead", dead},
        {"quarantined", quarantined},
        {"pairs", std::uint64_t(double(times.pairs) / steps)},
        {"projection_ms", ms(times.projection)},
        {"lists_ms", ms(times.lists)},
        {"forward_ms", ms(times.forward)},
        {"loss_ms", ms(times.loss)},
        {"backward_ms", ms(times.backward)},
        {"update_ms", ms(times.update)},
        {"step_ms", ms(times.total())}};
    std::printf("%s\n", line.dump().c_str());
    std::fflush(stdout);
    loss = 0;
    dead = 0;
  }
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "train_gaussians DATASET SCALE [NAME=VALUE]..\n");
    return 2;
  }
  try {
    return tureen::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "train_gaussians: %s\n", error.what());
    return 1;
  }
}
