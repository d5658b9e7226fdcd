// How the time of a frame grows with triangles, with pixels and with overdraw, on soups whose cost
// is known beforehand, and the model t = a + b triangles + c fragments + d shaded pixels fitted to
// all of it. Frames are timed by runtime/benchmark, as `tureen bench` does.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/cost_fit.hpp"
#include "bench/growth_report.hpp"
#include "bench/layered_soup.hpp"
#include "cli/machine.hpp"
#include "cli/version.hpp"
#include "runtime/benchmark.hpp"
#include "runtime/renderer.hpp"
#include "soup/error.hpp"
#include "support/contexts.hpp"

namespace tureen::test {
namespace {

using Kind = LayeredSoupOptions::Kind;

struct Options {
  std::size_t most_triangles = 4'000'000;
  double seconds = 6;  // a point
  std::string folder;
  bool quick = false;
  bool processor_time = false;
};

/// What is drawn for one point of a series.
struct Step {
  std::string series;
  std::size_t triangles;
  int layers;
  int width, height;
};

std::vector<Step> steps(const Options& options) {
  std::vector<Step> result;
  for (std::size_t triangles = 1000; triangles < options.most_triangles; triangles *= 4)
    result.push_back({"triangles", triangles, 4, 1280, 720});
  result.push_back({"triangles", options.most_triangles, 4, 1280, 720});
  const std::size_t middle = std::min<std::size_t>(options.most_triangles, 65536);
  for (const int height : {180, 360, 720, 1080, 1440, 2160})
    if (!options.quick || height <= 720)
      result.push_back({"pixels", middle, 4, height * 16 / 9, height});
  for (const int layers : {1, 2, 4, 8, 16, 32})
    if (!options.quick || layers <= 8) result.push_back({"overdraw", middle, layers, 1280, 720});
  return result;
}

double pixels_with_a_face(const Renderer& renderer) {
  const Image8 frame = renderer.read_color();
  return double(std::count_if(frame.pixels.begin(), frame.pixels.end(),
                              [](glm::u8vec4 pixel) { return pixel.a != 0; }));
}

GrowthPoint measure(const gl::Context& context, Kind kind, const Step& step,
                    const Options& options) {
  const LayeredSoupOptions soup_options{
      .triangles = step.triangles, .layers = step.layers, .kind = kind};
  const Scene scene = layered_soup(soup_options);
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  // A transparent background, by which pixels without a face are known.
  Renderer renderer(context, soup, scene.origin, RenderOptions{.background = glm::vec4(0)});
  const Camera camera = resized(scene.cameras[0], step.width, step.height);
  const Entrant entrant{"plan", [&](const Camera& view) { renderer.draw(view); },
                        [&] { renderer.finish(); }};
  BenchmarkOptions benchmark{.rounds = options.quick ? 3 : 15, .most_seconds = options.seconds};
  benchmark.least_sample_ms = 5;  // as `tureen bench`
  if (options.processor_time) benchmark.clock = processor_seconds;
  const BenchmarkResult result = run_benchmark({&entrant, 1}, {&camera, 1}, benchmark);
  const FrameStatistics statistics = statistics_of(result.entrants[0].times);
  return {.kind = kind == Kind::opaque ? "opaque" : "cut-out",
          .series = step.series,
          .layers = step.layers,
          .width = step.width,
          .height = step.height,
          .sample = {.triangles = double(soup.triangles.size()),
                     .fragments = layered_soup_fragments(soup_options, step.width, step.height),
                     .shaded_pixels = pixels_with_a_face(renderer),
                     .ms = statistics.min_of_medians},
          .p95_ms = statistics.p95,
          .aa_spread = result.aa_spread};
}

int run(int argc, char** argv) {
  CLI::App app{"How the time of a frame grows with triangles, pixels and overdraw"};
  Options options;
  app.add_option("-o,--output", options.folder, "A folder for growth.json, plots and growth.html");
  app.add_option("--triangles", options.most_triangles, "The largest soup")
      ->check(CLI::Range(1000, 32'000'000))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "For each point, at most")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  app.add_flag("--quick", options.quick, "Small soups and few rounds: a test, not a measurement");
  app.add_flag("--processor-time", options.processor_time,
               "Of all threads, instead of time that passed: for a busy machine; software only");
  CLI11_PARSE(app, argc, argv);
  if (options.quick) {
    options.most_triangles = std::min<std::size_t>(options.most_triangles, 16'000);
    options.seconds = std::min(options.seconds, 0.3);
  }
  if (!options.folder.empty()) std::filesystem::create_directories(options.folder);

  const gl::Context context = gl::Context::create({});
  Growth growth{.commit = cli::program_commit(),
                .cpu = cli::this_machine().cpu,
                .context = context.description(),
                .renderer = context.capabilities().renderer,
                .software = context.capabilities().software,
                .processor_time = options.processor_time};
  if (options.processor_time && !growth.software)
    throw UsageError("--processor-time says nothing of " + growth.renderer);
  for (const Kind kind : {Kind::opaque, Kind::cut_out})
    for (const Step& step : steps(options)) {
      growth.points.push_back(measure(context, kind, step, options));
      std::fprintf(stderr, "%s\n", point_line(growth.points.back()).c_str());
    }
  fit(growth);
  for (const std::string& line : explanation(growth)) std::printf("%s\n", line.c_str());
  if (!options.folder.empty()) write_growth(growth, options.folder);
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  try {
    return tureen::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
