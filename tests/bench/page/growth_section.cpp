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
    return fmt::format("{}x{}", point.at("width").get<int>(), point.at("height").get<int>());
  };
  std::vector<std::string> headings{series == "overdraw" ? "layers"
                                    : series == "pixels" ? "size"
                                                         : "triangles"};
  std::map<std::string, std::vector<std::string>> rows;
  double least = 1, most = 0;
  for (const Json& point : growth.at("points")) {
    if (point.at("series") != series) continue;
    std::vector<std::string>& row = rows[point.at("kind")];
    if (row.empty()) row.push_back(point.at("kind"));
    row.push_back(ms_text(point.at("ms")));
    least = std::min(least, point.at("aa_spread").get<double>());
    most = std::max(most, point.at("aa_spread").get<double>());
    if (rows.size() == 1) headings.push_back(place(point));
  }
  if (rows.empty()) return {};
  Table table(headings);
  for (const auto& [kind, row] : rows) table.line(row);
  return table.text() + fmt::format("A/A spreads {} to {}.\n\n", percent(least), percent(most));
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
  for (const char* series : {"triangles", "pixels", "overdraw"}) {
    section.text += growth_table(growth, series);
    add_plot(section, measurements.file(name, fmt::format("growth-{}.svg", series)),
             fmt::format("Frame time against {}", series));
  }
  section.text += "The fits, with their standard errors:\n\n" + fits_table(growth);
  add_plot(section, measurements.file(name, "growth-fit.svg"), "The model against measurements");
  // What growth_benchmark says of them; costs stand above.
  std::string line;
  for (const char c : measurements.text(name)) {
    line += c;
    if (c != '\n') continue;
    if (line.find("the model") != std::string::npos) section.text += "- " + line;
    line.clear();
  }
  section.text += "\n";
  return section;
}

}  // namespace tureen::test
