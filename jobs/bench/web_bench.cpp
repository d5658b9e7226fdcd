#include "jobs/bench/web_bench.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/json/json_file.hpp"
#include "jobs/bench/json_reading.hpp"
#include "jobs/bench/plan_json.hpp"

namespace tureen::results {

namespace {

constexpr const char* web_format_name = "tureen web bench";

/// Limit in milliseconds (eleven days), so that sums stay finite.
constexpr double max_ms = 1e9;

double mebibytes(const JsonView& bytes) { return double(bytes.natural()) / double(1 << 20); }

/// A duration in milliseconds, which may be 0.
double milliseconds(const JsonView& view) {
  const double ms = view.number();
  if (!(ms >= 0 && ms <= max_ms))
    view.fail(fmt::format("{} is not a time from 0 to {:g} ms", ms, max_ms));
  return ms;
}

double frame_milliseconds(const JsonView& view) {
  const double ms = milliseconds(view);
  if (ms == 0)
    view.fail("a frame took 0 ms: the clock is too coarse for this number of frames a sample");
  return ms;
}

/// A list of `rounds` lists, each with the times of `views` views.
FrameTimes frame_times(const JsonView& view, std::size_t views, std::size_t rounds) {
  if (view.size() != rounds)
    view.fail(fmt::format("has {} rounds, expected {}", view.size(), rounds));
  FrameTimes times{.views = views, .ms = {}};
  for (std::size_t r = 0; r < rounds; ++r) {
    const JsonView round = view.at(r);
    if (round.size() != views)
      round.fail(fmt::format("has {} views, expected {}", round.size(), views));
    for (std::size_t v = 0; v < views; ++v) times.ms.push_back(frame_milliseconds(round.at(v)));
  }
  return times;
}

std::string hash_of(const JsonView& view) {
  const std::string& text = view.text();
  if (text.size() != 16 || text.find_first_not_of("0123456789abcdef") != std::string::npos)
    view.fail("expected 16 hexadecimal digits");
  return text;
}

BenchConfiguration configuration_of(const JsonView& view) {
  const std::optional<JsonView> applied = view.find("specialisations");
  return {.name = view["name"].text(),
          .options = {},
          .plan = texts(view["plan"]),
          .plan_ms = milliseconds(view["plan_ms"]),
          .upload_ms = milliseconds(view["upload_ms"]),
          .device_mib = mebibytes(view["device_bytes"]),
          .specialisations =
              applied ? specialisations_of(*applied) : std::vector<AppliedSpecialisation>()};
}

/// The part that the cases of one measurement share.
BenchMeasurement shared_part(const JsonView& view) {
  const JsonView cases = view["entrants"];
  if (cases.size() == 0) cases.fail("has no cases");
  const JsonView first = cases.at(0)["frame_ms"];
  if (first.size() == 0) first.fail("has no rounds");
  if (first.at(0).size() == 0) first.at(0).fail("has no views");
  BenchMeasurement shared;
  shared.camera_set = view["camera_set"].text();
  shared.width = count_of(view["width"]);
  shared.height = count_of(view["height"]);
  shared.size = fmt::format("{}x{}", shared.width, shared.height);
  shared.frame_ms.rounds = int(first.size());
  shared.views = int(first.at(0).size());
  shared.frames_per_sample = count_of(view["frames_per_sample"]);
  const std::uint64_t frames = std::uint64_t(shared.frame_ms.rounds) * std::uint64_t(shared.views) *
                               shared.frames_per_sample;
  if (frames > std::uint64_t(std::numeric_limits<int>::max()))
    view["frames_per_sample"].fail("too many frames");
  shared.frames = int(frames);
  const JsonView self_test = view["self_test_ms"];
  if (self_test.size() != 2) self_test.fail("expected the times of two runs");
  const std::size_t rounds = self_test.at(0).size();
  if (rounds == 0) self_test.at(0).fail("has no rounds");
  shared.aa_spread = series_spread(frame_times(self_test.at(0), std::size_t(shared.views), rounds),
                                   frame_times(self_test.at(1), std::size_t(shared.views), rounds));
  shared.passes_gap = PassTimesGap::no_timers;
  shared.passes_reason = "browsers do not report them";
  return shared;
}

/// Adds one measurement of the page: one BenchMeasurement per case.
void add_measurements(const JsonView& view, BenchResult& result) {
  const BenchMeasurement shared = shared_part(view);
  const std::size_t begin = result.measurements.size();
  const JsonView cases = view["entrants"];
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const JsonView benchmark_case = cases.at(i);
    BenchMeasurement measurement = shared;
    measurement.configuration = benchmark_case["configuration"].text();
    if (std::none_of(
            result.configurations.begin(), result.configurations.end(),
            [&](const BenchConfiguration& each) { return each.name == measurement.configuration; }))
      benchmark_case["configuration"].fail("is not a configuration of the scene");
    for (std::size_t k = begin; k < result.measurements.size(); ++k)
      if (result.measurements[k].configuration == measurement.configuration)
        benchmark_case["configuration"].fail("appears twice");
    measurement.stable = benchmark_case["stable"].boolean();
    measurement.pixels_hash = hash_of(benchmark_case["pixels_hash"]);
    const FrameTimes times = frame_times(benchmark_case["frame_ms"], std::size_t(shared.views),
                                         std::size_t(shared.frame_ms.rounds));
    measurement.frame_ms = statistics_of(times);
    measurement.fps = 1000 / measurement.frame_ms.mean;
    measurement.views_ms = view_medians(times);
    result.measurements.push_back(std::move(measurement));
  }
  result.protocol.rounds = std::max(result.protocol.rounds, shared.frame_ms.rounds);
  result.protocol.aa_spread = std::max(result.protocol.aa_spread, shared.aa_spread);
}

/// The part of the result that all scenes of the file share.
BenchResult result_of_page(const JsonView& root) {
  const JsonView page = root["page"], device = root["device"];
  const double pixel_ratio = device["pixel_ratio"].number();
  if (!(pixel_ratio > 0 && pixel_ratio <= 100)) device["pixel_ratio"].fail("expected 0 to 100");
  BenchResult result;
  result.date = date_of(root["date"]);
  result.program = {
      .version = page["version"].text(), .commit = page["commit"].text(), .arguments = {}};
  result.machine = {
      .cpu = device["user_agent"].text(), .cores = integer(device["cores"]), .memory_mib = 0};
  result.device = {
      .context = fmt::format("WebGL2, {:g} pixels a CSS pixel on a screen of {} x {}", pixel_ratio,
                             count_of(device["screen_width"]), count_of(device["screen_height"])),
      .renderer = device["renderer"].text(),
      .vendor = device["vendor"].text(),
      .version = device["gl_version"].text(),
      .software = device["software"].boolean()};
  result.protocol.clock = root["protocol"]["clock"].text();
  result.notes.push_back("measured in a browser: " + page["address"].text());
  return result;
}

BenchResult result_of_scene(const JsonView& view, BenchResult result) {
  result.scene = {.name = view["name"].text(),
                  .path = view["source"].text(),
                  .triangles = view["triangles"].natural(),
                  .appearance = view["appearance"].text()};
  result.configurations = list(view["configurations"], configuration_of);
  if (result.configurations.empty()) view["configurations"].fail("is empty");
  const BenchConfiguration& first = result.configurations.front();
  result.load = {.read_ms = milliseconds(view["read_ms"]),
                 .plan_ms = first.plan_ms,
                 .upload_ms = first.upload_ms,
                 .device_mib = first.device_mib};
  result.peak_mib = mebibytes(view["wasm_bytes"]);  // measured last; it never shrinks
  const JsonView measurements = view["measurements"];
  if (measurements.size() == 0) measurements.fail("is empty");
  for (std::size_t i = 0; i < measurements.size(); ++i)
    add_measurements(measurements.at(i), result);
  for (std::string& note : texts(view["notes"])) result.notes.push_back(std::move(note));
  return result;
}

}  // namespace

std::vector<BenchResult> read_web_bench(Input& input) {
  const nlohmann::json document = read_json(input);
  const JsonView root(document, input.name());
  require_format(root, web_format_name, web_bench_version, "not a download of bench.html");
  const BenchResult shared = result_of_page(root);
  const JsonView scenes = root["scenes"];
  if (scenes.size() == 0) scenes.fail("is empty");
  return list(scenes, [&](const JsonView& scene) { return result_of_scene(scene, shared); });
}

}  // namespace tureen::results
