// `tureen bench`: frame times across resolutions.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>

#include "base/error.hpp"
#include "base/steady_seconds.hpp"
#include "base/suggestion.hpp"
#include "cli/bench/bench_reports.hpp"
#include "cli/bench/bench_table.hpp"
#include "cli/commands.hpp"
#include "cli/files/image_file.hpp"
#include "cli/interrupt.hpp"
#include "cli/measuring/bench_device.hpp"
#include "cli/measuring/bench_views.hpp"
#include "cli/options/arguments.hpp"
#include "cli/options/drawing_options.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/version.hpp"
#include "jobs/bench/bench_cases.hpp"
#include "jobs/bench/bench_measure.hpp"
#include "jobs/timing/benchmark.hpp"
#include "scene/edit/baked_transform.hpp"

namespace tureen::cli {

namespace {

struct BenchCaseArguments {
  DrawingOptions drawing;
  std::vector<std::string> only;  // names of cases; empty: the default cases
  bool ceilings = false;
};

struct BenchOptions {
  SceneArgument scene;
  BenchViewOptions views;
  BenchCaseArguments cases;
  int rounds = 5;
  double seconds = 20;
  bool processor_time = false;
  BenchReportOptions reports;
  std::vector<std::string> arguments;  // of the program, as typed
};

/// --only, --ceilings and the drawing options that all commands share.
void add_case_options(Command& command, BenchCaseArguments& options) {
  add_drawing_options(command, options.drawing);
  add_drawing_scale(command, options.drawing);
  command
      .add_option(
          "--only NAME,..", options.only,
          "cases to measure, separated by commas: tureen (the plan), tureen-fragment and "
          "tureen-compute (triangles: the plan with --shading), raster and tiles (splats: the plan "
          "with --blend), generic (no specialisation), baseline, triangles and copy (upper limits "
          "on speed, see --ceilings); ratios are relative to the first case")
      .comma_list();
  command.add_flag("--ceilings", options.ceilings,
                   "also measure two upper limits on speed: drawing the triangles with an empty "
                   "fragment shader, and copying the same number of pixels");
}

/// Throws UsageError for unknown names.
void check(const BenchCaseArguments& options) {
  const std::span<const std::string> all_names = bench_case_names();
  for (std::size_t i = 0; i < options.only.size(); ++i) {
    const std::string& name = options.only[i];
    if (std::find(all_names.begin(), all_names.end(), name) == all_names.end())
      throw UsageError(
          "--only takes tureen, tureen-fragment, tureen-compute, raster, tiles, generic, baseline, "
          "triangles and copy, not '" +
              name + "'",
          did_you_mean(name, all_names));
    if (std::find(options.only.begin(), options.only.begin() + std::ptrdiff_t(i), name) !=
        options.only.begin() + std::ptrdiff_t(i))
      throw UsageError("--only names " + name + " twice");
  }
  // Two names for one case.
  if (std::count(options.only.begin(), options.only.end(), "baseline") > 0 &&
      std::count(options.only.begin(), options.only.end(), "published") > 0)
    throw UsageError("--only names the baseline twice: as baseline and as published");
}

/// "tureen_hemisphere-8_1280x720.png".
std::string image_name_of(const BenchMeasurement& measurement) {
  std::string name =
      measurement.configuration + "_" + measurement.camera_set + "_" + measurement.size;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '.') c = '-';
  return name + ".png";
}

/// Throws UsageError for several layers.
BenchScene described(Scene& scene, const std::string& path) {
  Layer& layer = only_layer(scene);
  if (const auto* splats = std::get_if<Splats>(&layer.primitives))
    return {scene.info.name, path, 0, describe(*splats), count(*splats)};
  // Chosen views and the baseline's plan are of world coordinates.
  bake_transform(layer);
  const TriangleSoup& soup = only_soup(scene);
  return {scene.info.name, path, soup.triangles.size(), appearance_name(soup.appearance)};
}

BenchLoad load_of(const BenchCases& cases, double read_ms) {
  const BenchConfiguration& first = cases.list.front()->configuration;
  return {.read_ms = read_ms,
          .plan_ms = first.plan_ms,
          .upload_ms = first.upload_ms,
          .peak_mib = cases.peak_mib,
          .device_mib = first.device_mib};
}

void add_measurements(BenchResult& result, std::vector<BenchMeasurement> measurements) {
  for (BenchMeasurement& each : measurements) {
    result.protocol.aa_spread = std::max(result.protocol.aa_spread, each.aa_spread);
    result.measurements.push_back(std::move(each));
  }
}

BenchResult run(const BenchOptions& options) {
  BenchResult result;
  result.date = utc_now();
  result.program = {program_version(), program_commit(), options.arguments, program_build()};
  result.machine = this_machine();
  result.protocol.rounds = options.rounds;

  const double start = steady_seconds();
  Scene scene = read(options.scene);
  const double read_ms = 1000 * (steady_seconds() - start);
  apply_opaque(scene, options.cases.drawing);
  result.scene = described(scene, options.scene.path);
  result.notes = notes_of(scene.info);
  const BenchViewList views = bench_views(options.views, scene, options.scene.path);
  result.notes.insert(result.notes.end(), views.notes.begin(), views.notes.end());

  const gl::Context context = gl::Context::create({.backend = options.cases.drawing.backend});
  throw_if_interrupted();
  result.device = device_of(context);
  result.machine.rasteriser_threads = rasteriser_threads_of(result.device.renderer);
  const BenchClock clock = clock_for(result.device, options.processor_time);
  result.protocol.clock = clock.text;
  result.protocol.processor_time = options.processor_time;
  const BenchCases cases = make_cases({.pipeline = options.cases.drawing.pipeline,
                                       .plan = preferences_for(scene, options.cases.drawing),
                                       .only = options.cases.only,
                                       .ceilings = options.cases.ceilings,
                                       .opaque = options.cases.drawing.opaque},
                                      context, scene);
  for (const SkippedCase& each : cases.skipped)
    result.notes.push_back(each.name + " is skipped: " + each.reason);
  result.load = load_of(cases, read_ms);
  result.load.disk_mib = double(bytes_on_disk(options.scene.path)) / bytes_per_mib;
  result.load.memory_mib = double(byte_size(scene)) / bytes_per_mib;
  Progress progress("timing");
  MeasureOptions measuring{.rounds = options.rounds, .max_seconds = options.seconds};
  measuring.clock = clock.now;
  measuring.progress = [&](double fraction, const std::string& what) {
    progress.update(fraction, what);
  };
  if (!options.reports.folder.empty())
    measuring.keep_frame = [&](const BenchMeasurement& measurement, const Image8& frame) {
      const std::filesystem::path path =
          std::filesystem::path(options.reports.folder) / image_name_of(measurement);
      write_image(frame, path);
      return path.string();
    };
  add_measurements(result, measure(cases, views.views, measuring));
  if (const double peak = peak_mib(); peak > 0) result.peak_mib = peak;
  for (const auto& bench_case : cases.list)
    result.configurations.push_back(bench_case->configuration);
  return result;
}

/// Paths that are read: the scene, the dataset, and --cameras, which may name files.
std::vector<std::string> inputs_of(const BenchOptions& options) {
  std::vector<std::string> inputs = options.views.cameras;
  inputs.push_back(options.scene.path);
  if (!options.views.dataset.empty()) inputs.push_back(options.views.dataset);
  return inputs;
}

ExitCode bench(const BenchOptions& options) {
  if (options.reports.fail_slower && options.rounds < min_rounds)
    throw UsageError(
        fmt::format("--fail-slower needs at least {} rounds to estimate the spread", min_rounds));
  // Wrong arguments are reported before the scene is read.
  check(options.views);
  check(options.cases);
  const std::optional<BenchResult> then =
      prepare_bench_reports(options.reports, inputs_of(options));

  const BenchResult result = run(options);
  say_list("Notes:", result.notes);
  say_list("Plan of " + result.configurations.front().name + ":",
           result.configurations.front().plan);
  for (const std::string& line : bench_table(result)) say(line);
  return report_bench(options.reports, result, then);
}

}  // namespace

void add_bench(Command& program, std::vector<std::string> arguments) {
  auto options = std::make_shared<BenchOptions>();
  options->arguments = std::move(arguments);
  Command command = program.add_command("bench", "Measure frame times");
  command.footer(
      R"(Draws frames alternately with the plan, with the pipeline without specialisations, and
with the baseline if it supports the scene. If the plan blends splats in tiles (--blend), the
case "raster" draws them by the GPU instead. Every frame of splats includes projection and sorting; the
table lists the time of sorting. Warm-up frames run until the times are stable.
A frame ends when the device has finished. First, the first case is compared with itself (A/A).
"best ms" is the smallest of the rounds' medians; ratios use it. Two times are "equal" if
they differ by at most twice the spread. The spread is the larger of the A/A spread and the
spread between rounds.
Differences are reported only if at least 3 rounds were run. The 99th percentile and the 1 % low
need 100 samples; a sample is one view in one round. Loading is measured separately.

Examples:
  tureen bench soup.glb                                   8 views from above at 1280x720
  tureen bench soup.glb --sweep --json > bench.json       5 sizes
  tureen bench soup.glb --size 640x360,1920x1080 --cameras orbit:12,adversarial
  tureen bench soup.glb photographs --sizes full,half     the dataset's test cameras
  tureen bench soup.glb --ceilings -o timed               report.html, bench.json, images
  tureen bench soup.glb --against timed/bench.json        changes since that result
  tureen bench soup.glb --only tureen,triangles --seconds 60
  tureen bench soup.glb --only tureen-fragment,tureen-compute
                                                          fragment against compute shaders
  tureen bench splats.ply --only raster,baseline          splats on the GPU only

Exit codes: 0 done, 1 slower than --fail-slower allows, 2 wrong usage, 3 the scene or the
cameras cannot be read, 4 no OpenGL context, 5 the scene does not fit on the device, or
the output cannot be written.)");
  add_scene_argument(command, options->scene);
  add_memory_option(command);
  add_bench_view_options(command, options->views);
  add_case_options(command, options->cases);
  command.add_option("--rounds N", options->rounds,
                     "largest number of rounds over all views, 5 by default", between(1, 10000));
  command.add_option("--seconds S", options->seconds,
                     "approximate time limit in seconds, 20 by default, 0 for no limit; reduces "
                     "the number of rounds, to at least 1",
                     between(0.0, 1e6));
  command.add_flag("--processor-time", options->processor_time,
                   "measure the CPU time of all threads instead of elapsed time, for ratios "
                   "on a busy machine; software OpenGL only");
  add_bench_report_options(command, options->reports);
  command.does([options] { return bench(*options); });
}

}  // namespace tureen::cli
