#include "cli/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace tureen::cli {

namespace {

/// Number of UTF-8 code points: all bytes except continuation bytes.
std::size_t width_of(const std::string& text) {
  return std::size_t(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

Table::Table(const std::vector<std::string>& headings) {
  Row heading;
  for (const std::string& text : headings) {
    const bool is_marked = text.starts_with('<');
    aligned_left_.push_back(is_marked || aligned_left_.empty());
    heading.cells.push_back(text.substr(is_marked ? 1 : 0));
  }
  const auto is_empty = [](const std::string& cell) { return cell.empty(); };
  if (!std::all_of(heading.cells.begin(), heading.cells.end(), is_empty))
    rows_.push_back(std::move(heading));
}

void Table::row(std::vector<std::string> cells) {
  assert(cells.size() <= aligned_left_.size());
  rows_.push_back({std::move(cells)});
}

void Table::remark(std::string text) { rows_.push_back({{"", std::move(text)}, true}); }

std::vector<std::string> Table::lines() const {
  std::vector<std::size_t> widths(aligned_left_.size());
  for (const Row& row : rows_)
    for (std::size_t i = 0; i < row.cells.size() && !row.is_remark; ++i)
      widths[i] = std::max(widths[i], width_of(row.cells[i]));
  std::vector<std::string> lines;
  for (const Row& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const std::size_t width = width_of(row.cells[i]);
      const std::string padding(std::max(widths[i], width) - width, ' ');
      const bool left = aligned_left_[i] || row.is_remark;
      line += (i > 0 ? "  " : "") + (left ? row.cells[i] + padding : padding + row.cells[i]);
    }
    lines.push_back(line.substr(0, line.find_last_not_of(' ') + 1));
  }
  return lines;
}

std::string ms_text(double ms) { return fmt::format("{:.{}f}", ms, ms < 1 ? 3 : ms < 10 ? 2 : 1); }

}  // namespace tureen::cli
