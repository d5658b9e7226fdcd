// A part of a page of docs/ that is measured, as Markdown, and what such parts are made of.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/page/measurements.hpp"

namespace tureen::test {

struct Section {
  /// The measurement's, or what the names of all of a kind begin with: "frames-example", "slim".
  std::string name;
  /// When, where and by which command, tables, and plots as links into images/.
  std::string text;
  struct Plot {
    std::filesystem::path from;
    std::string name;  // in images/
  };
  std::vector<Plot> plots = {};
};

/// When and where, and the command as a block to be copied; of several measurements all commands.
std::string head(const Measurements& measurements, const std::vector<std::string>& names);

/// Takes a plot into the section, with its link; nothing where gnuplot drew none. `from` lies in
/// its measurement's folder, by which it is named in images/.
void add_plot(Section& section, const std::filesystem::path& from, const std::string& shown);

class Table {
 public:
  explicit Table(const std::vector<std::string>& headings);
  void line(const std::vector<std::string>& cells);
  /// With an empty line behind it.
  std::string text() const { return text_ + "\n"; }

 private:
  std::string text_;
};

/// Three digits that count, between a tenth of a millisecond and a second.
std::string ms_text(double ms);

/// "1.3 %" of 0.013.
std::string percent(double fraction);

/// By a format of fmt's, or a dash where it is no number.
std::string number_or_none(const Json& value, const char* format);

}  // namespace tureen::test
