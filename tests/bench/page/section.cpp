#include "bench/page/section.hpp"

#include <fmt/format.h>

#include "support/measured.hpp"

namespace tureen::test {

namespace {

namespace fs = std::filesystem;

std::string where(const Measurements::Run& run) {
  return fmt::format("{} at {}, {} cores of {}", run.date.substr(0, 10), run.commit, run.cores,
                     run.cpu);
}

}  // namespace

std::string head(const Measurements& measurements, const std::vector<std::string>& names) {
  std::string places, commands;
  for (const std::string& name : names) {
    const Measurements::Run run = measurements.run(name);
    const std::string place = where(run);
    if (places.find(place) == std::string::npos) places += (places.empty() ? "" : "; ") + place;
    commands += run.command + "\n";
  }
  return fmt::format("Measured {}:\n\n```\n{}```\n\n", places, commands);
}

Table::Table(const std::vector<std::string>& headings) {
  line(headings);
  text_ += "|";
  for (std::size_t i = 0; i < headings.size(); ++i) text_ += "---|";
  text_ += "\n";
}

void Table::line(const std::vector<std::string>& cells) {
  text_ += "|";
  for (const std::string& cell : cells) text_ += " " + table_cell(cell) + " |";
  text_ += "\n";
}

std::string ms_text(double ms) {
  return fmt::format("{:.{}f}", ms, ms < 1 ? 3 : ms < 10 ? 2 : ms < 100 ? 1 : 0);
}

std::string percent(double fraction) { return fmt::format("{:.1f} %", 100 * fraction); }

std::string number_or_none(const Json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "–";
}

void add_plot(Section& section, const fs::path& from, const std::string& shown) {
  if (!fs::exists(from)) return;
  // Named by the measurement: a section of several has plots of one file name.
  section.plots.push_back({from, fmt::format("bench-{}-{}", from.parent_path().filename().string(),
                                             from.filename().string())});
  section.text += fmt::format("![{}](images/{})\n\n", shown, section.plots.back().name);
}

}  // namespace tureen::test
