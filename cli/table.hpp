// Tables on the terminal: the one place that aligns columns.
#pragma once

#include <string>
#include <vector>

namespace tureen::cli {

/// Columns two spaces apart, each as wide as its widest cell in Unicode code points.
class Table {
 public:
  /// Headings; no heading line if all are empty. The first column and columns whose heading begins
  /// with '<' are aligned left, the others right.
  explicit Table(const std::vector<std::string>& headings);

  /// Cells from the left; at most as many as headings.
  void row(std::vector<std::string> cells);

  /// A remark on the row above, on its own line from the second column. It does not widen the
  /// column.
  void remark(std::string text);

  /// The lines, without trailing spaces.
  std::vector<std::string> lines() const;

 private:
  struct Row {
    std::vector<std::string> cells;
    bool is_remark = false;
  };
  std::vector<bool> aligned_left_;
  std::vector<Row> rows_;
};

/// Milliseconds with three significant digits, down to a microsecond: "0.123", "7.89", "52.0".
std::string ms_text(double ms);

}  // namespace tureen::cli
