// Tables for spreadsheets and scripts: RFC 4180, with lines that end in LF.
#pragma once

#include <span>
#include <string>

namespace tureen::cli {

/// The cells of a row, quoted where they hold what would end them, and the line's end.
std::string csv_line(std::span<const std::string> cells);

}  // namespace tureen::cli
