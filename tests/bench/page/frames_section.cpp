#include "bench/page/frames_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cli/bench_words.hpp"
#include "cli/gnuplot.hpp"

namespace tureen::test {

namespace {

using cli::BenchMeasurement;
using cli::BenchResult;

BenchResult bench_of(const Measurements& measurements, const std::string& name) {
  constexpr const char* file = "bench.json";
  return cli::bench_result_from_json(measurements.text_of(name, file),
                                     measurements.file(name, file).string());
}

/// The measurements of one set of cameras at one size, by configuration.
struct Place {
  std::string cameras, size;
  double aa_spread = 0;
  std::map<std::string, BenchMeasurement> by_configuration = {};

  /// Nullptr where it was not timed.
  const BenchMeasurement* find(const std::string& configuration) const {
    const auto found = by_configuration.find(configuration);
    return found == by_configuration.end() ? nullptr : &found->second;
  }
};

std::vector<Place> places_of(const BenchResult& bench) {
  std::vector<Place> places;
  for (const BenchMeasurement& m : bench.measurements) {
    auto place = std::find_if(places.begin(), places.end(), [&](const Place& p) {
      return p.cameras == m.camera_set && p.size == m.size;
    });
    if (place == places.end()) place = places.insert(place, {m.camera_set, m.size, m.aa_spread});
    place->by_configuration[m.configuration] = m;
  }
  return places;
}

std::string best_text(const BenchMeasurement& m) {
  return ms_text(m.frame_ms.min_of_medians) + (m.stable ? "" : cli::restless_mark);
}

/// Its best time, and how many times as long that is as the first configuration's.
std::string against_first(const Place& place, const std::string& name,
                          const BenchMeasurement& first) {
  const BenchMeasurement* own = place.find(name);
  if (!own) return cli::not_known;
  const double ratio = own->frame_ms.min_of_medians / first.frame_ms.min_of_medians;
  return fmt::format("{} ({})", best_text(*own), cli::ratio_text(ratio, *own, first));
}

/// What the marks of a table mean, behind it; empty where it has none.
std::string marks_text(const std::string& table) {
  return table.find(cli::restless_mark) == std::string::npos
             ? std::string()
             : std::string(cli::restless_sentence) + "\n\n";
}

std::string bench_table(const BenchResult& bench) {
  const std::string& first = bench.configurations.front().name;
  std::vector<std::string> headings{"cameras",
                                    "size",
                                    "rounds",
                                    "frames",
                                    "A/A spread",
                                    "spread",
                                    first + " ms",
                                    first + " p50",
                                    first + " p95",
                                    first + " p99 ms",
                                    first + " 1 % low FPS"};
  for (std::size_t i = 1; i < bench.configurations.size(); ++i)
    headings.push_back(bench.configurations[i].name + " ms (times)");
  Table table(headings);
  for (const Place& place : places_of(bench)) {
    const BenchMeasurement* ours = place.find(first);
    if (!ours) continue;
    const FrameStatistics& ms = ours->frame_ms;
    std::vector<std::string> cells{
        place.cameras,
        place.size,
        std::to_string(ms.rounds),
        std::to_string(ours->frames),
        percent(place.aa_spread),
        cli::spread_text(ms),
        best_text(*ours),
        ms_text(ms.median),
        ms_text(ms.p95),
        cli::slowest_percent_text(ms, ms_text(ms.p99)),
        cli::slowest_percent_text(ms, fmt::format("{:.1f}", ms.low_1_percent_fps))};
    for (std::size_t i = 1; i < bench.configurations.size(); ++i)
      cells.push_back(against_first(place, bench.configurations[i].name, *ours));
    table.line(cells);
  }
  return table.text() + marks_text(table.text());
}

/// How it was measured; which machine and commit, the section's head says.
std::string bench_device(const BenchResult& bench) {
  std::string text = bench.device.renderer + (bench.device.software ? ", software" : "");
  if (const auto& threads = bench.machine.rasteriser_threads)
    text += fmt::format(", rasteriser threads: {}", *threads);
  if (!bench.program.build.empty()) text += "; " + bench.program.build + " build";
  return text + "; " + bench.protocol.clock + ".";
}

/// How much of what the device can do the first configuration reaches, at least: a frame takes as
/// long as the slower of the ceilings.
std::string of_ceiling(const Place& place, const BenchMeasurement& first) {
  double ceiling_ms = 0;
  for (const char* name : {"triangles", "copy"})
    if (const BenchMeasurement* ceiling = place.find(name))
      ceiling_ms = std::max(ceiling_ms, ceiling->frame_ms.min_of_medians);
  return ceiling_ms > 0 ? percent(ceiling_ms / first.frame_ms.min_of_medians) : cli::not_known;
}

}  // namespace

Section bench_section(const Measurements& measurements, const std::string& name) {
  const BenchResult bench = bench_of(measurements, name);
  Section section{.name = name, .text = head(measurements, {name}), .plots = {}};
  section.text += fmt::format("{} triangles; ", bench.scene.triangles) + bench_device(bench) +
                  " Times are the smallest of the rounds' medians; in brackets how many times as "
                  "long as the first, whose rounds have the *spread*: " +
                  cli::ratio_sentence + "\n\n" + bench_table(bench);
  std::map<std::string, int> sizes;
  for (const Place& place : places_of(bench)) ++sizes[place.cameras];
  for (const auto& [cameras, count] : sizes) {
    if (count < 2) continue;
    const std::string file = cli::plot_identifier("pixels " + cameras) + ".svg";
    add_plot(section, measurements.file(name, file),
             "Frame time against pixels, cameras " + cameras);
  }
  add_plot(section, measurements.file(name, "ratios.svg"),
           "Times as fast, as measured: also where a spread explains it");
  return section;
}

Section stages_section(const Measurements& measurements, const std::vector<std::string>& names) {
  Section section{.name = "stages", .text = head(measurements, names), .plots = {}};
  section.text += bench_device(bench_of(measurements, names.front())) + " In brackets " +
                  cli::ratio_sentence + "\n\n";
  Table table({"scene", "cameras", "size", "rounds", "frames", "A/A spread", "spread",
               "fragment ms", "compute ms (times)"});
  for (const std::string& name : names) {
    const BenchResult bench = bench_of(measurements, name);
    if (bench.configurations.size() < 2) continue;
    const std::string &first = bench.configurations[0].name, &second = bench.configurations[1].name;
    for (const Place& place : places_of(bench))
      if (const BenchMeasurement* fragment = place.find(first))
        table.line({name.substr(std::string("stages-").size()), place.cameras, place.size,
                    std::to_string(fragment->frame_ms.rounds), std::to_string(fragment->frames),
                    percent(place.aa_spread), cli::spread_text(fragment->frame_ms),
                    best_text(*fragment), against_first(place, second, *fragment)});
  }
  section.text += table.text() + marks_text(table.text());
  return section;
}

Section gpu_section(const Measurements& measurements, const std::vector<std::string>& names) {
  Section section{.name = "gpu", .text = head(measurements, names), .plots = {}};
  section.text += bench_device(bench_of(measurements, names.front())) +
                  " FPS is 1000 divided by the mean in milliseconds. Of the ceiling: the slower of "
                  "triangles and copy against the first. In brackets " +
                  cli::ratio_sentence + "\n\n";
  const std::vector<std::string> others{"published", "triangles", "copy", "tureen-fragment",
                                        "tureen-compute"};
  std::vector<std::string> headings{"scene",      "triangles", "cameras", "size", "frames",
                                    "A/A spread", "spread",    "ours ms", "FPS",  "of the ceiling"};
  for (const std::string& other : others) headings.push_back(other + " ms (times)");
  Table table(headings);
  for (const std::string& name : names) {
    const BenchResult bench = bench_of(measurements, name);
    for (const Place& place : places_of(bench)) {
      const BenchMeasurement* ours = place.find("tureen");
      if (!ours) continue;
      std::vector<std::string> cells{name.substr(std::string("gpu-").size()),
                                     std::to_string(bench.scene.triangles),
                                     place.cameras,
                                     place.size,
                                     std::to_string(ours->frames),
                                     percent(place.aa_spread),
                                     cli::spread_text(ours->frame_ms),
                                     best_text(*ours),
                                     fmt::format("{:.0f}", ours->fps),
                                     of_ceiling(place, *ours)};
      for (const std::string& other : others) cells.push_back(against_first(place, other, *ours));
      table.line(cells);
    }
  }
  section.text += table.text() + marks_text(table.text());
  return section;
}

}  // namespace tureen::test
