// The stages of the steps of a training run of splats on one core, in milliseconds, and their sum
// over the time of the image loss in the same run. Prints ten JSON lines: means over tenths of the
// run. `tureen train` measures quality. With a scene, the run begins with its splats.
//
//   splat_steps gaussians|triangles|neural DATASET SCALE [CONFIG.json [SCENE]]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/existing_path.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/scene_file.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/neural/neural_training.hpp"
#include "trainer/splats/splat_config.hpp"
#include "trainer/splats/windows/window_training.hpp"

namespace tureen::test {
namespace {

using namespace trainer;

template <class Trainer>
void print_stages(Trainer& trainer) {
  const SplatTimes times = std::exchange(trainer.times(), {});
  const double steps = double(times.steps);
  const auto ms = [&](double seconds) { return std::round(1e5 * seconds / steps) / 100; };
  const nlohmann::ordered_json line = {
      {"step", trainer.steps_done()},
      {"splats", trainer.parameters().count()},
      {"pairs", std::uint64_t(double(times.pairs) / steps)},  // of a splat and a tile
      {"projection_ms", ms(times.projection)},
      {"lists_ms", ms(times.lists)},
      {"forward_ms", ms(times.forward)},
      {"loss_ms", ms(times.loss)},
      {"backward_ms", ms(times.backward)},
      {"update_ms", ms(times.update)},
      {"step_ms", ms(times.total())},
      {"step_over_loss", std::round(100 * times.total() / times.loss) / 100}};
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

/// The images of the dataset are already views; and figures compare with earlier ones.
template <class Config>
Config random_start(Config config) {
  if (config.initialisation == Initialisation::automatic)
    config.initialisation = Initialisation::random;
  return config;
}

template <class Training>
void train(const typename Training::Config& config, const Dataset& dataset,
           std::vector<TrainingView> views, const std::optional<Scene>& start) {
  const Region region = region_of_interest(dataset);
  for (TrainingView& view : views) view.camera = relative_to(view.camera, region.center);
  SplatTrainer<Training> trainer(
      config, views, {.center = glm::dvec3(0), .half_side = region.half_side}, 1,
      first_splats<Training>(dataset, random_start(config), region, start ? &*start : nullptr));
  while (!trainer.done()) {
    const int tenth = trainer.steps_done() * 10 / config.steps;
    trainer.step();
    if (trainer.steps_done() * 10 / config.steps != tenth) print_stages(trainer);
  }
}

template <class Config>
Config config_of(int count, char** values) {
  return count > 4 ? read_splat_config<Config>(open_existing(values[4])) : Config{};
}

void run(int count, char** values) {
  if (count < 4 || count > 6)
    throw std::runtime_error("needs METHOD DATASET SCALE [CONFIG.json [SCENE]]");
  std::optional<Scene> start;
  if (count > 5) start = read_scene(values[5]);
  const std::string method = values[1];
  Dataset dataset = read_dataset(values[2], {.scale = std::atof(values[3])});
  const auto views = [&](const SplatConfig& config) {
    return take_training_views(dataset.train, std::span<const float, 3>(config.background));
  };
  if (method == "gaussians") {
    const auto config = config_of<GaussianConfig>(count, values);
    if (config.flat)
      train<DiscTraining>(config, dataset, views(config), start);
    else
      train<GaussianTraining>(config, dataset, views(config), start);
  } else if (method == "triangles") {
    const auto config = config_of<WindowConfig>(count, values);
    train<WindowTraining>(config, dataset, views(config), start);
  } else if (method == "neural") {
    const auto config = config_of<NeuralConfig>(count, values);
    train<NeuralTraining>(config, dataset, views(config), start);
  } else {
    throw std::runtime_error(method + ": no such method");
  }
}

}  // namespace
}  // namespace tureen::test

int main(int count, char** values) {
  try {
    tureen::test::run(count, values);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "splat_steps: %s\n", error.what());
    return 1;
  }
}
