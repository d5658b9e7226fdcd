// Trains triangle windows on a dataset, on one core, and prints the PSNR of held-out views and the
// time of each stage against seconds of processor time in steps. Prints JSON lines. With opaque=1,
// the last line has the PSNR of the opaque triangles, drawn by the oracle.
//
//   train_windows DATASET SCALE STEPS [NAME=VALUE ..]
//
// Names: splats, marks, first, size, opacity_weight, size_weight, sampling (an
// index of window_sampling_words), half, growth, opaque, from, until, sigma, seed, every,
// densify_until, degree, and images (a folder for images of the first held-out views).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "formats/dataset/dataset.hpp"
#include "image/metrics.hpp"
#include "oracle/oracle.hpp"
#include "scene/scene.hpp"
#include "trainer/splats/window_method.hpp"

namespace tureen::test {
namespace {

using namespace trainer;

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

double psnr_of(const std::vector<float>& planes, const TrainingView& view) {
  double squared = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double value = std::round(255 * std::clamp(double(planes[i]), 0.0, 1.0));
    squared += std::pow((value - view.target[i]) / 255, 2);
  }
  return psnr_from_mse(squared / double(planes.size()));
}

double mean_psnr(WindowTrainer& trainer, const std::vector<TrainingView>& views) {
  double sum = 0;
  for (const TrainingView& view : views) sum += psnr_of(trainer.render(view.camera), view);
  return sum / double(views.size());
}

/// Planes of red, green and blue as a portable pixmap.
void write_image(const std::string& path, const std::vector<float>& planes, const Camera& camera) {
  std::ofstream file(path, std::ios::binary);
  file << "P6 " << camera.width << ' ' << camera.height << " 255\n";
  const std::size_t pixels = planes.size() / 3;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    for (std::size_t c = 0; c < 3; ++c)
      file.put(char(std::lround(255 * std::clamp(double(planes[c * pixels + pixel]), 0.0, 1.0))));
}

std::vector<float> soup_planes(const Scene& scene, const Camera& camera, int supersampling) {
  const OracleImage image =
      render_oracle(scene, {camera}, {.supersampling = supersampling, .background = glm::vec3(1)});
  std::vector<float> planes;
  for (int c = 0; c < 3; ++c)
    for (const auto& pixel : image.color.pixels) planes.push_back(float(pixel[c]));
  return planes;
}

std::map<std::string, std::string> options_of(int argc, char** argv) {
  std::map<std::string, std::string> result;
  for (int i = 4; i < argc; ++i) {
    const std::string text = argv[i];
    const std::size_t at = text.find('=');
    if (at == std::string::npos) throw std::runtime_error(text + ": not NAME=VALUE");
    result[text.substr(0, at)] = text.substr(at + 1);
  }
  return result;
}

int run(int argc, char** argv) {
  std::map<std::string, std::string> options = options_of(argc, argv);
  const auto number = [&](const char* name, double otherwise) {
    const auto found = options.extract(name);
    return found ? std::atof(found.mapped().c_str()) : otherwise;
  };
  WindowConfig config;
  config.steps = std::atoi(argv[3]);
  config.max_splats = std::size_t(number("splats", double(config.max_splats)));
  config.first_splats = std::size_t(number("first", double(config.first_splats)));
  config.first_size = float(number("size", config.first_size));
  config.opacity_weight = float(number("opacity_weight", config.opacity_weight));
  config.size_weight = float(number("size_weight", config.size_weight));
  config.sampling = WindowSampling(int(number("sampling", 0)));
  config.half_size_until = number("half", config.half_size_until);
  config.growth = number("growth", config.growth);
  config.densify_every = int(number("every", config.densify_every));
  config.degree = int(number("degree", config.degree));
  config.densify_until = number("densify_until", config.densify_until);
  config.opaque = number("opaque", 0) > 0;
  config.opaque_from = number("from", config.opaque_from);
  config.opaque_until = number("until", config.opaque_until);
  config.variance_weight = float(number("variance_weight", config.variance_weight));
  config.seed = std::uint64_t(number("seed", 0));
  const int marks = int(number("marks", 10));
  const auto folder = options.extract("images");
  if (!options.empty()) throw std::runtime_error(options.begin()->first + ": no such option");

  Dataset dataset = read_dataset(argv[1], {.scale = std::atof(argv[2])});
  const Region region = region_of_interest(dataset);
  const std::span<const float, 3> background(config.background);
  const std::vector<TrainingView> train = take_training_views(dataset.train, background);
  const std::vector<TrainingView> test = take_training_views(dataset.test, background);
  WindowTrainer trainer(config, train, region, 1);
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
        {"step_ms", ms(times.total())},
        {"step_over_loss", std::round(100 * times.total() / times.loss) / 100}};
    std::printf("%s\n", line.dump().c_str());
    std::fflush(stdout);
    loss = 0;
    dead = 0;
  }
  const auto save = [&](const std::string& name, std::size_t view,
                        const std::vector<float>& planes) {
    if (folder)
      write_image(folder.mapped() + "/" + name + std::to_string(view) + ".ppm", planes,
                  test[view].camera);
  };
  for (std::size_t view = 0; view < std::min<std::size_t>(test.size(), 3); ++view)
    save("soft", view, trainer.render(test[view].camera));
  if (config.opaque) {
    Scene scene;
    scene.layers.push_back({.primitives = WindowTraining::primitives(config, trainer.parameters(),
                                                                     trainer.state().memory)});
    double sums[2] = {0, 0};
    for (std::size_t view = 0; view < test.size(); ++view)
      for (const int which : {0, 1}) {
        const std::vector<float> planes = soup_planes(scene, test[view].camera, which == 0 ? 1 : 4);
        sums[which] += psnr_of(planes, test[view]);
        if (view < 3) save(which == 0 ? "opaque" : "opaque_4x4_", view, planes);
      }
    const nlohmann::ordered_json line = {
        {"triangles", std::get<TriangleSoup>(scene.layers[0].primitives).triangles.size()},
        {"opaque_psnr_db", std::round(100 * sums[0] / double(test.size())) / 100},
        {"opaque_4x4_psnr_db", std::round(100 * sums[1] / double(test.size())) / 100}};
    std::printf("%s\n", line.dump().c_str());
  }
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "train_windows DATASET SCALE STEPS [NAME=VALUE ..]\n");
    return 2;
  }
  try {
    return tureen::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "train_windows: %s\n", error.what());
    return 1;
  }
}
