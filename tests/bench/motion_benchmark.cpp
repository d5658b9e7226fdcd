// Antialiasing in motion (runtime/passes/motion.hpp) along an orbit: its time, and its images
// against those with 8 x 8 samples a pixel, beside frames with one sample. Frames with and without
// it alternate. Prints one row of JSON a scene. Flicker is the error of the change from one frame
// to the next, as root mean square in steps of 1 / 255.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "camera/navigation.hpp"
#include "formats/scene_file.hpp"
#include "jobs/timing/benchmark.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/renderer.hpp"
#include "tests/bench/run_program.hpp"

namespace tureen::test {
namespace {

struct Settings {
  int width = 1280, height = 720;
  int frames = 48;
  double degrees = 0.5;  // a frame
  std::vector<std::filesystem::path> scenes;
};

struct Errors {
  double squared = 0, change = 0;
  std::size_t values = 0, changes = 0;

  void add(const Image8& image, const Image8& truth, const Image8* image_before,
           const Image8* truth_before) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double error = double(image.pixels[i][c]) - truth.pixels[i][c];
        squared += error * error;
        ++values;
        if (!image_before) continue;
        const double before = double(image_before->pixels[i][c]) - truth_before->pixels[i][c];
        change += (error - before) * (error - before);
        ++changes;
      }
  }
  double psnr() const { return 10 * std::log10(255.0 * 255.0 * double(values) / squared); }
  double flicker() const { return std::sqrt(change / double(changes)); }
};

void measure(const gl::Context& context, const Settings& settings,
             const std::filesystem::path& path) {
  const Scene scene = read_scene(path);
  const auto renderer = [&](int supersampling) {
    const RenderOptions options{.plan = {.quality = {.supersampling = supersampling}},
                                .background = glm::vec4(scene.info.background, 1)};
    return Renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                    options);
  };
  Renderer plain = renderer(1), smooth = renderer(1), truth = renderer(8);
  if (!smooth.can_smooth_motion()) throw std::runtime_error(path.string() + ": not only soups");
  smooth.smooth_motion(true);
  const Subject subject = subject_of(scene);
  const int around = int(std::lround(360 / settings.degrees));
  std::vector<Camera> cameras =
      orbit(subject, around, three_quarter_view,
            {.width = settings.width, .height = settings.height});
  const bool software = context.capabilities().software;
  if (!software) throw std::runtime_error("times are processor times, for software OpenGL");
  constexpr int warm_up = 16;
  Errors with, without;
  std::vector<double> ratios, ms;
  Image8 before[3];
  for (int i = 0; i < warm_up + settings.frames; ++i) {
    const FrameInput input{cameras[std::size_t(i % around)]};
    double seconds[2];
    Renderer* both[] = {&plain, &smooth};
    for (int k = 0; k < 2; ++k) {
      const double start = processor_seconds();
      both[k]->draw(input);
      both[k]->finish();
      seconds[k] = processor_seconds() - start;
    }
    truth.draw(input);
    const Image8 images[] = {plain.read_color(), smooth.read_color(), truth.read_color()};
    if (i >= warm_up) {
      ratios.push_back(seconds[1] / seconds[0]);
      ms.push_back(1e3 * seconds[0]);
      without.add(images[0], images[2], &before[0], &before[2]);
      with.add(images[1], images[2], &before[1], &before[2]);
    }
    for (int k = 0; k < 3; ++k) before[k] = images[k];
  }
  std::printf("%s\n", nlohmann::json{{"scene", path.stem().string()},
                                     {"plain_ms", percentile(ms, 50)},
                                     {"ratio", percentile(ratios, 50)},
                                     {"psnr_db", {without.psnr(), with.psnr()}},
                                     {"flicker", {without.flicker(), with.flicker()}}}
                          .dump()
                          .c_str());
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app("Measures antialiasing in motion along an orbit.");
  app.add_option("scenes", settings.scenes)->required();
  app.add_option("--frames", settings.frames, "number of frames")->check(CLI::PositiveNumber);
  app.add_option("--degrees", settings.degrees, "angle of a frame")->check(CLI::PositiveNumber);
  app.add_option("--width", settings.width)->check(CLI::PositiveNumber);
  app.add_option("--height", settings.height)->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const gl::Context context = gl::Context::create({});
  for (const auto& path : settings.scenes) measure(context, settings, path);
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  return tureen::test::run_program("motion_benchmark", tureen::test::run, argc, argv);
}
