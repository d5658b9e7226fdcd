#include "cli/bench_csv.hpp"

#include <fmt/format.h>

#include <functional>
#include <vector>

#include "cli/csv.hpp"

namespace tureen::cli {

namespace {

struct Column {
  const char* name;
  std::function<std::string(const BenchResult&, const BenchMeasurement&)> value;
};

/// All digits: reading the text gives the same number.
template <class Number>
std::string number(Number value) {
  return fmt::format("{}", value);
}

/// Of p99 or the 1 % low; empty where that would be the slowest sample.
std::string slowest_percent(const BenchMeasurement& m, double figure) {
  return tells_slowest_percent(m.frame_ms) ? number(figure) : std::string();
}

/// A column of the measurement, or of what all measurements have in common.
template <class Get>
Column of(const char* name, Get get) {
  return {name, [get](const BenchResult&, const BenchMeasurement& m) { return get(m); }};
}
template <class Get>
Column of_all(const char* name, Get get) {
  return {name, [get](const BenchResult& r, const BenchMeasurement&) { return get(r); }};
}

/// The sentences of the configuration's plan; of ceilings, which have none, empty.
std::string plan_of(const BenchResult& result, const BenchMeasurement& measurement) {
  const BenchConfiguration* configuration = find_configuration(result, measurement.configuration);
  std::string text;
  if (configuration)
    for (const std::string& sentence : configuration->plan)
      text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

const std::vector<Column>& columns() {
  using M = const BenchMeasurement&;
  using R = const BenchResult&;
  static const std::vector<Column> all{
      of("configuration", [](M m) { return m.configuration; }),
      of("camera_set", [](M m) { return m.camera_set; }),
      of("size", [](M m) { return m.size; }),
      of("width", [](M m) { return number(m.width); }),
      of("height", [](M m) { return number(m.height); }),
      of("views", [](M m) { return number(m.views); }),
      of("rounds", [](M m) { return number(m.frame_ms.rounds); }),
      of("frames", [](M m) { return number(m.frames); }),
      of("mean_ms", [](M m) { return number(m.frame_ms.mean); }),
      of("median_ms", [](M m) { return number(m.frame_ms.median); }),
      of("p95_ms", [](M m) { return number(m.frame_ms.p95); }),
      of("p99_ms", [](M m) { return slowest_percent(m, m.frame_ms.p99); }),
      of("min_of_medians_ms", [](M m) { return number(m.frame_ms.min_of_medians); }),
      of("spread", [](M m) { return number(m.frame_ms.spread); }),
      of("aa_spread", [](M m) { return number(m.aa_spread); }),
      of("fps", [](M m) { return number(m.fps); }),
      of("low_1_percent_fps", [](M m) { return slowest_percent(m, m.frame_ms.low_1_percent_fps); }),
      of("stable", [](M m) { return std::string(m.stable ? "true" : "false"); }),
      of("gpu_ms", [](M m) { return m.gpu_ms ? number(*m.gpu_ms) : std::string(); }),
      of("pixels_hash", [](M m) { return m.pixels_hash; }),
      of_all("scene", [](R r) { return r.scene.name; }),
      of_all("triangles", [](R r) { return number(r.scene.triangles); }),
      of_all("renderer", [](R r) { return r.device.renderer; }),
      of_all("cpu", [](R r) { return r.machine.cpu; }),
      of_all("commit", [](R r) { return r.program.commit; }),
      of_all("date", [](R r) { return r.date; }),
      of_all("driver", [](R r) { return r.device.version; }),
      {"plan", plan_of},
      of_all("build", [](R r) { return r.program.build; }),
      of_all("rasteriser_threads",
             [](R r) {
               const std::optional<int>& threads = r.machine.rasteriser_threads;
               return threads ? number(*threads) : std::string();
             }),
  };
  return all;
}

}  // namespace

std::string bench_csv(std::span<const BenchResult> results) {
  std::string text;
  const auto line = [&](const auto& cell) {
    std::vector<std::string> cells;
    for (const Column& column : columns()) cells.push_back(cell(column));
    text += csv_line(cells);
  };
  line([](const Column& column) { return std::string(column.name); });
  for (const BenchResult& result : results)
    for (const BenchMeasurement& measurement : result.measurements)
      line([&](const Column& column) { return column.value(result, measurement); });
  return text;
}

}  // namespace tureen::cli
