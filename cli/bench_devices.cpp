#include "cli/bench_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "cli/bench_markdown.hpp"
#include "cli/bench_words.hpp"
#include "cli/html_page.hpp"

namespace tureen::cli {

namespace {

constexpr const char* meaning =
    "Best milliseconds a frame: the smallest of the rounds' medians. Where the processor draws "
    "(software), times say nothing about graphics hardware.";

/// With the mark's, where a row has one.
std::string meaning_of(const DeviceTable& table) {
  for (const auto& row : table.rows)
    for (const std::string& cell : row)
      if (cell.ends_with(restless_mark)) return std::string(meaning) + " " + restless_sentence;
  return meaning;
}

/// What makes two measurements ones of the same thing.
using Key = std::tuple<std::string, std::uint64_t, std::string, std::string, std::string>;

Key key_of(const BenchResult& result, const BenchMeasurement& m) {
  return {result.scene.name, result.scene.triangles, m.camera_set, m.size, m.configuration};
}

/// Of a terminal: characters, of which UTF-8 makes several bytes.
std::size_t columns_of(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::string described(const DeviceBench& device) {
  const BenchResult& first = device.results.front();
  return fmt::format("{}: {}{}, {}; {}; {}; commit {}", device.name, first.device.renderer,
                     first.device.software ? " (software)" : "", first.device.context,
                     first.machine.cpu, first.date, first.program.commit);
}

std::string best_ms(const DeviceBench& device, const Key& key) {
  for (const BenchResult& result : device.results)
    for (const BenchMeasurement& m : result.measurements)
      if (key_of(result, m) == key) {
        const double ms = m.frame_ms.min_of_medians;
        return fmt::format("{:.{}f}{}", ms, ms < 10 ? 3 : 1, m.stable ? "" : restless_mark);
      }
  return "";
}

}  // namespace

DeviceTable device_table(std::span<const DeviceBench> devices) {
  DeviceTable table;
  table.headings = {"scene", "cameras", "size", "configuration"};
  std::vector<Key> keys;
  for (const DeviceBench& device : devices) {
    table.devices.push_back(described(device));
    table.headings.push_back(device.name);
    for (const BenchResult& result : device.results)
      for (const BenchMeasurement& m : result.measurements)
        if (const Key key = key_of(result, m);
            std::find(keys.begin(), keys.end(), key) == keys.end())
          keys.push_back(key);
  }
  for (const Key& key : keys) {
    const auto& [scene, triangles, cameras, size, configuration] = key;
    std::vector<std::string> row{fmt::format("{} ({} triangles)", scene, counted(triangles)),
                                 cameras, size, configuration};
    for (const DeviceBench& device : devices) row.push_back(best_ms(device, key));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> device_lines(const DeviceTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.headings.size(); ++c) {
    widths.push_back(columns_of(table.headings[c]));
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], columns_of(row[c]));
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t c = 0; c < cells.size(); ++c)
      text += c < device_table_keys ? fmt::format("  {:<{}}", cells[c], widths[c])
                                    : fmt::format("  {:>{}}", cells[c], widths[c]);
    return text.substr(0, text.find_last_not_of(' ') + 1);
  };
  std::vector<std::string> lines = table.devices;
  lines.push_back(meaning_of(table));
  lines.push_back(line(table.headings));
  for (const auto& row : table.rows) lines.push_back(line(row));
  return lines;
}

std::string device_markdown(const DeviceTable& table) {
  std::string text;
  for (const std::string& device : table.devices) text += "- " + markdown_cell(device) + "\n";
  text += "\n" + meaning_of(table) + "\n\n";
  const auto line = [&](const std::vector<std::string>& cells) {
    text += "|";
    for (const std::string& cell : cells) text += " " + markdown_cell(cell) + " |";
    text += "\n";
  };
  line(table.headings);
  text += "|";
  for (std::size_t c = 0; c < table.headings.size(); ++c)
    text += c < device_table_keys ? "---|" : "---:|";
  text += "\n";
  for (const auto& row : table.rows) line(row);
  return text;
}

std::string device_page(const DeviceTable& table) {
  HtmlPage page("Frame times by device");
  page.list(table.devices);
  page.paragraph(meaning_of(table));
  std::vector<HtmlPage::Heading> headings;
  for (const std::string& heading : table.headings)
    headings.push_back({heading, headings.size() < device_table_keys ? HtmlPage::Column::text
                                                                     : HtmlPage::Column::number});
  page.table(headings, table.rows);
  return page.text();
}

}  // namespace tureen::cli
