#include "bench/page/growth_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace tureen::test {

namespace {

/// A row a kind, a column a point of what grows.
std::string growth_table(const Json& growth, const std::string& series) {
  const auto place = [&](const Json& point) -> std::string {
    if (series == "triangles") return fmt::format("{:.0f}", point.at("triangles").get<double>());
    if (series == "overdraw") return std::to_string(point.at("layers").get<int>());
    if (series == "shape") return fmt::format("{:.3g}", point.at("elongation").get<double>());
    return fmt::format("{}x{}", point.at("width").get<int>(), point.at("height").get<int>());
  };
  std::vector<std::string> headings{series == "overdraw" ? "layers"
                                    : series == "pixels" ? "size"
                                    : series == "shape"  ? "width / height of a cell"
                                                         : "triangles"};
  std::map<std::string, std::vector<std::string>> rows;
  std::vector<double> aa_spreads, spreads;
  std::vector<std::size_t> rounds;
  int unsettled = 0;
  for (const Json& point : growth.at("points")) {
    if (point.at("series") != series) continue;
    std::vector<std::string>& row = rows[point.at("kind")];
    if (row.empty()) row.push_back(point.at("kind"));
    row.push_back(ms_text(point.at("ms")));
    aa_spreads.push_back(point.at("aa_spread"));
    spreads.push_back(point.at("spread"));
    rounds.push_back(point.at("round_ms").size());
    unsettled += point.at("unsettled_rounds").get<int>();
    if (rows.size() == 1) headings.push_back(place(point));
  }
  if (rows.empty()) return {};
  Table table(headings);
  for (const auto& [kind, row] : rows) table.line(row);
  const auto range = [](const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return percent(*low) + " to " + percent(*high);
  };
  const auto [fewest, most] = std::minmax_element(rounds.begin(), rounds.end());
  return table.text() +
         fmt::format(
             "A/A spreads {}, spreads of the rounds {}; {}{} rounds{}.\n\n", range(aa_spreads),
             range(spreads), *fewest, *fewest == *most ? "" : fmt::format(" to {}", *most),
             unsettled ? fmt::format(", {} of all begun before a point was stable", unsettled)
                       : "");
}

std::string fits_table(const Json& growth) {
  Table table({"", "a frame, ms", "a triangle, ns", "a fragment, ns", "a shaded pixel, ns"});
  for (const auto& [kind, of_kind] : growth.at("fits").items()) {
    const Json& fit = of_kind;  // what lambdas capture has to be a variable
    const auto cost = [&](const char* key, std::size_t i, double unit) {
      return fmt::format("{:.3g} ± {:.2g}", fit.at(key).get<double>(),
                         unit * fit.at("standard_errors_ms").at(i).get<double>());
    };
    table.line({kind, cost("frame_ms", 0, 1), cost("triangle_ns", 1, 1e6),
                cost("fragment_ns", 2, 1e6), cost("shaded_pixel_ns", 3, 1e6)});
  }
  return table.text();
}

}  // namespace

Section growth_section(const Measurements& measurements, const std::string& name) {
  const Json growth = measurements.json(name, "growth.json");
  Section section{.name = name, .text = head(measurements, {name}), .plots = {}};
  section.text +=
      fmt::format("{}{}, {}. Milliseconds, the smallest of the rounds' medians.\n\n",
                  growth.at("renderer").get<std::string>(),
                  growth.at("software").get<bool>() ? ", software" : "",
                  growth.at("processor_time").get<bool>() ? "processor time of all threads"
                                                          : "the time that passes");
  for (const char* series : {"triangles", "pixels", "overdraw", "shape"}) {
    section.text += growth_table(growth, series);
    add_plot(section, measurements.file(name, fmt::format("growth-{}.svg", series)),
             fmt::format("Frame time against {}", series));
  }
  if (!growth.at("fits").empty()) {
    section.text += "The fits, with their standard errors:\n\n" + fits_table(growth);
    add_plot(section, measurements.file(name, "growth-fit.svg"), "The model against measurements");
  }
  // All that growth_benchmark says, also where it could fit nothing, but costs, which stand above.
  std::string line;
  for (const char c : measurements.text(name)) {
    line += c;
    if (c != '\n') continue;
    if (line.find("a frame costs") == std::string::npos) section.text += "- " + line;
    line.clear();
  }
  section.text += "\n";
  return section;
}

}  // namespace tureen::test
