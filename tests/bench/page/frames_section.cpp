#include "bench/page/frames_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cli/gnuplot.hpp"
#include "runtime/frame_statistics.hpp"

namespace tureen::test {

namespace {

std::vector<std::string> configurations(const Json& bench) {
  std::vector<std::string> names;
  for (const Json& each : bench.at("configurations")) names.push_back(each.at("name"));
  return names;
}

double best_ms(const Json& measurement) { return measurement.at("frame_ms").at("min_of_medians"); }

/// The measurements of one set of cameras at one size, by configuration.
struct Place {
  std::string cameras, size;
  double aa_spread = 0;
  std::map<std::string, Json> by_configuration;
};

std::vector<Place> places_of(const Json& bench) {
  std::vector<Place> places;
  for (const Json& m : bench.at("measurements")) {
    const std::string cameras = m.at("camera_set"), size = m.at("size");
    auto place = std::find_if(places.begin(), places.end(), [&](const Place& p) {
      return p.cameras == cameras && p.size == size;
    });
    if (place == places.end()) place = places.insert(place, {cameras, size, m.at("aa_spread"), {}});
    place->by_configuration[m.at("configuration")] = m;
  }
  return places;
}

/// Its best time, and how many times as long that is as the first configuration's.
std::string against_first(const Place& place, const std::string& name, const std::string& first) {
  const auto own = place.by_configuration.find(name), ours = place.by_configuration.find(first);
  if (own == place.by_configuration.end() || ours == place.by_configuration.end()) return "–";
  const double a = best_ms(own->second), b = best_ms(ours->second);
  return ms_text(a) +
         (differ(a, b, place.aa_spread) ? fmt::format(" ({:.2f})", a / b) : " (equal)");
}

std::string bench_table(const Json& bench) {
  const std::vector<std::string> names = configurations(bench);
  const std::string& first = names.front();
  std::vector<std::string> headings{
      "cameras",      "size",         "A/A spread",      first + " ms",
      first + " p50", first + " p95", first + " p99 ms", first + " 1 % low FPS"};
  for (std::size_t i = 1; i < names.size(); ++i) headings.push_back(names[i] + " ms (times)");
  Table table(headings);
  for (const Place& place : places_of(bench)) {
    const auto ours = place.by_configuration.find(first);
    if (ours == place.by_configuration.end()) continue;
    const Json& m = ours->second;
    std::vector<std::string> cells{place.cameras,
                                   place.size,
                                   percent(place.aa_spread),
                                   ms_text(best_ms(m)),
                                   ms_text(m.at("frame_ms").at("median")),
                                   ms_text(m.at("frame_ms").at("p95")),
                                   ms_text(m.at("frame_ms").at("p99")),
                                   fmt::format("{:.1f}", m.at("low_1_percent_fps").get<double>())};
    for (std::size_t i = 1; i < names.size(); ++i)
      cells.push_back(against_first(place, names[i], first));
    table.line(cells);
  }
  return table.text();
}

std::string bench_device(const Json& bench) {
  const Json& device = bench.at("device");
  return fmt::format("{}{}; {}.", device.at("renderer").get<std::string>(),
                     device.at("software").get<bool>() ? ", software" : "",
                     bench.at("protocol").at("clock").get<std::string>());
}

}  // namespace

Section bench_section(const Measurements& measurements, const std::string& name) {
  const Json bench = measurements.json(name, "bench.json");
  Section section{.name = name, .text = head(measurements, {name}), .plots = {}};
  section.text +=
      fmt::format("{} triangles; ", bench.at("scene").at("triangles").get<std::uint64_t>()) +
      bench_device(bench) +
      " Times are the smallest of the rounds' medians; in brackets how many times as "
      "long as the first.\n\n" +
      bench_table(bench);
  std::map<std::string, int> sizes;
  for (const Place& place : places_of(bench)) ++sizes[place.cameras];
  for (const auto& [cameras, count] : sizes) {
    if (count < 2) continue;  // a plot of a single point
    const std::string file = cli::plot_identifier("pixels " + cameras) + ".svg";
    add_plot(section, measurements.file(name, file),
             "Frame time against pixels, cameras " + cameras);
  }
  add_plot(section, measurements.file(name, "ratios.svg"), "Times as fast");
  return section;
}

Section stages_section(const Measurements& measurements, const std::vector<std::string>& names) {
  Section section{.name = "stages", .text = head(measurements, names), .plots = {}};
  section.text += bench_device(measurements.json(names.front(), "bench.json")) + "\n\n";
  Table table({"scene", "cameras", "size", "A/A spread", "fragment ms", "compute ms (times)"});
  for (const std::string& name : names) {
    const Json bench = measurements.json(name, "bench.json");
    const std::vector<std::string> stages = configurations(bench);
    if (stages.size() < 2) continue;
    for (const Place& place : places_of(bench))
      if (const auto fragment = place.by_configuration.find(stages[0]);
          fragment != place.by_configuration.end())
        table.line({name.substr(std::string("stages-").size()), place.cameras, place.size,
                    percent(place.aa_spread), ms_text(best_ms(fragment->second)),
                    against_first(place, stages[1], stages[0])});
  }
  section.text += table.text();
  return section;
}

}  // namespace tureen::test
