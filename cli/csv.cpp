#include "cli/csv.hpp"

namespace tureen::cli {

namespace {

/// Between quotation marks where the text holds what would end a cell.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

}  // namespace

std::string csv_line(std::span<const std::string> cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i ? "," : "") + field(cells[i]);
  return line + "\n";
}

}  // namespace tureen::cli
