// How the time of a frame grows with triangles, with pixels and with overdraw, on soups whose cost
// is known beforehand, and the model t = a + b triangles + c fragments + d shaded pixels fitted to
// all of it. Frames are timed by runtime/benchmark, as `tureen bench` does.
//
// A round goes through all points of a kind: each is warmed up until it is stable, for its data are
// no longer in the caches, and then timed some times in a row, of which the round has the median.
// So what the machine does over minutes hits all points alike, and no time is divided by another:
// drift is told by what returns, the rounds of a point and the frame that every series has.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
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
  int rounds = 8;        // even: every second one is held against the one before it
  double seconds = 150;  // a kind
  std::string folder;
  bool quick = false;
  bool processor_time = false;
};

/// What is drawn for one point of a series. What does not grow is that of the frame that every
/// series has.
struct Step {
  std::string series;
  std::size_t triangles;
  int layers = 4;
  int width = 1280, height = 720;
  double elongation = 1;

  bool operator==(const Step&) const = default;
};

/// Triangles where nothing else is said; one of the series of triangles.
std::size_t middle(const Options& options) {
  return std::min<std::size_t>(options.most_triangles, 65536);
}

std::vector<Step> steps(const Options& options) {
  std::vector<Step> result;
  for (std::size_t triangles = 1024; triangles < options.most_triangles; triangles *= 4)
    result.push_back({.series = "triangles", .triangles = triangles});
  result.push_back({.series = "triangles", .triangles = options.most_triangles});
  for (const int height : {180, 360, 720, 1080, 1440, 2160})
    if (!options.quick || height <= 720)
      result.push_back({.series = "pixels",
                        .triangles = middle(options),
                        .width = height * 16 / 9,
                        .height = height});
  for (const int layers : {1, 2, 4, 8, 16, 32})
    if (!options.quick || layers <= 8)
      result.push_back({.series = "overdraw", .triangles = middle(options), .layers = layers});
  for (const double elongation : {1.0, 4.0, 16.0})
    result.push_back({.series = "shape", .triangles = middle(options), .elongation = elongation});
  return result;
}

double pixels_with_a_face(const Renderer& renderer) {
  const Image8 frame = renderer.read_color();
  return double(std::count_if(frame.pixels.begin(), frame.pixels.end(),
                              [](glm::u8vec4 pixel) { return pixel.a != 0; }));
}

/// A point, ready to be drawn, and its times so far.
struct Frame {
  GrowthPoint point;
  Camera camera;
  Renderer renderer;
  FrameTimes times;
};

Frame prepare(const gl::Context& context, Kind kind, const Step& step, const Options& options) {
  const LayeredSoupOptions soup_options{.triangles = step.triangles,
                                        .layers = step.layers,
                                        .elongation = step.elongation,
                                        .kind = kind};
  const Scene scene = layered_soup(soup_options);
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  GrowthPoint point{.kind = kind == Kind::opaque ? "opaque" : "cut-out",
                    .series = step.series,
                    .layers = step.layers,
                    .width = step.width,
                    .height = step.height,
                    .elongation = step.elongation,
                    .anchor = step == Step{.series = step.series, .triangles = middle(options)}};
  point.sample.triangles = double(soup.triangles.size());
  point.sample.fragments = layered_soup_fragments(soup_options, step.width, step.height);
  const Camera camera = resized(scene.cameras[0], step.width, step.height);
  // A transparent background, by which pixels without a face are known.
  Renderer renderer(context, soup, scene.origin, RenderOptions{.background = glm::vec4(0)});
  renderer.draw(camera);
  point.sample.shaded_pixels = pixels_with_a_face(renderer);
  return {std::move(point), camera, std::move(renderer), {}};
}

/// A round of one point.
void time_round(Frame& frame, const Options& options) {
  const Entrant entrant{"plan", [&](const Camera& view) { frame.renderer.draw(view); },
                        [&] { frame.renderer.finish(); }};
  const std::vector<Camera> views(options.quick ? 3 : 8, frame.camera);
  BenchmarkOptions benchmark{.rounds = 1, .self_test = BenchmarkOptions::SelfTest::leave_out};
  benchmark.least_sample_ms = 5;  // as `tureen bench`
  // Data come back into the caches within some frames; a machine that does not come to rest in this
  // time will not for a while.
  benchmark.most_warm_up_seconds = options.quick ? 0.1 : 0.5;
  if (options.processor_time) benchmark.clock = processor_seconds;
  const BenchmarkResult result = run_benchmark({&entrant, 1}, views, benchmark);
  const FrameTimes& times = result.entrants[0].times;
  frame.times.views = times.views;
  frame.times.ms.insert(frame.times.ms.end(), times.ms.begin(), times.ms.end());
  if (!result.entrants[0].stable) ++frame.point.unsettled_rounds;
}

std::vector<GrowthPoint> measure(const gl::Context& context, Kind kind, const Options& options) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  Clock::time_point start = Clock::now();
  std::vector<Frame> frames;
  for (const Step& step : steps(options)) frames.push_back(prepare(context, kind, step, options));
  std::fprintf(stderr, "%s: %zu points in %.0f s\n", frames[0].point.kind.c_str(), frames.size(),
               seconds_since(start));
  start = Clock::now();
  for (int round = 0; round < options.rounds; ++round) {
    if (round >= least_rounds && seconds_since(start) * (round + 1) / round > options.seconds)
      break;
    for (Frame& frame : frames) time_round(frame, options);
    std::fprintf(stderr, "%s: %d rounds in %.0f s\n", frames[0].point.kind.c_str(), round + 1,
                 seconds_since(start));
  }
  std::vector<GrowthPoint> points;
  for (Frame& frame : frames) {
    take_times(frame.point, frame.times);
    std::fprintf(stderr, "%s\n", point_line(frame.point).c_str());
    points.push_back(std::move(frame.point));
  }
  return points;
}

int run(int argc, char** argv) {
  CLI::App app{"How the time of a frame grows with triangles, pixels and overdraw"};
  Options options;
  app.add_option("-o,--output", options.folder, "A folder for growth.json, plots and growth.html");
  app.add_option("--triangles", options.most_triangles, "The largest soup")
      ->check(CLI::Range(1000, 32'000'000))
      ->capture_default_str();
  app.add_option("--rounds", options.rounds, "In each of which every point has its turn")
      ->check(CLI::Range(least_rounds, 1000))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds,
                 "For the rounds of a kind, at most; three are always made")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  app.add_flag("--quick", options.quick, "Small soups and few rounds: a test, not a measurement");
  app.add_flag("--processor-time", options.processor_time,
               "Of all threads, instead of time that passed: for a busy machine; software only");
  CLI11_PARSE(app, argc, argv);
  if (options.quick) {
    options.most_triangles = std::min<std::size_t>(options.most_triangles, 16'000);
    options.rounds = least_rounds;
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
    for (GrowthPoint& point : measure(context, kind, options))
      growth.points.push_back(std::move(point));
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
