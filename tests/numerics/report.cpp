// Puts what the tests of numerics measured into docs/numerics.md: a row a case between two marks,
// everything else in the page stays as people wrote it; and a plot of those that say most.
//
// Nothing is written where one of the cases that the page has to have was not measured.
//
//   numerics_report MEASURED PAGE IMAGES
//
// MEASURED is the folder that TUREEN_MEASURED named, IMAGES where the plots go, relative to PAGE's
// folder.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "cli/gnuplot.hpp"
#include "soup/error.hpp"
#include "support/measured.hpp"

namespace tureen::test {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double infinity = std::numeric_limits<double>::infinity();

// The page's families in their order, and which of their cases are plotted.
constexpr const char* families = "GDVTSOHCMR";
constexpr const char* plotted[] = {"G3", "D1", "V1", "V1b", "S1", "M1"};

// The cases that the page has to have: one that is no longer measured must not vanish unnoticed.
constexpr const char* required[] = {
    "G1", "G2",  "G3",  "G3b", "G4",  "G5", "G6",  "G7", "G8",  "G9",                      //
    "D1", "D2",                                                                            //
    "V1", "V1b", "V1c", "V1d", "V2",  "V3", "V3b", "V4", "V5",                             //
    "T1", "T1b", "T2",  "T3",  "T4",  "T5", "T5b", "T6", "T6b", "T7", "T7b", "T8", "T9",   //
    "S1", "S2",  "S3",  "S4",  "S5",                                                       //
    "O1", "O2",  "O3",  "O4",  "O5",  "O6", "O7",                                          //
    "H1", "H1b", "H1c", "H2",  "H2b", "H3", "H4",  "H5", "H6",  "H7", "H8",  "H9", "H10",  //
    "C1", "C2",  "C2b", "C3",  "C4",                                                       //
    "M1", "M2",  "M3",  "M4",  "M5",                                                       //
    "R1", "R2",  "R3",  "R3b", "R4",  "R5", "R6",  "R7", "R8",  "R9"};

struct Point {
  double at, ours, tolerance;
  std::optional<double> naive;
};

struct Row {
  std::string test, id, stressed, parameter, unit, naive, file;
  std::vector<Point> points;

  /// Family, number, what is appended: G2, G3, G3b, G10.
  auto key() const {
    const std::string all = families;
    const std::size_t family = all.find(id[0]);
    std::size_t digits = 1;
    while (digits < id.size() && std::isdigit(static_cast<unsigned char>(id[digits]))) ++digits;
    return std::tuple(family, std::stoi(id.substr(1, digits - 1)), id.substr(digits), file);
  }
};

double number(const Json& value) { return value.is_number() ? value.get<double>() : infinity; }

Row read_row(const Measured& measured) {
  const Json& json = measured.json;
  Row row{.test = json.at("test"),
          .id = {},
          .stressed = json.at("stressed"),
          .parameter = json.at("parameter"),
          .unit = json.at("unit"),
          .naive = json.at("naive"),
          .file = measured.name,
          .points = {}};
  row.id = row.test.substr(0, row.test.find('_'));
  if (!json.at("passed").get<bool>())
    throw InputError({measured.name, {}, {}}, "the test " + row.test + " failed");
  for (const Json& point : json.at("points")) {
    row.points.push_back({number(point.at("at")), number(point.at("ours")),
                          number(point.at("tolerance")), std::nullopt});
    if (point.contains("naive")) row.points.back().naive = number(point.at("naive"));
  }
  return row;
}

std::vector<Row> read_rows(const fs::path& folder) {
  std::vector<Row> rows;
  for (const Measured& measured : read_measured(folder)) rows.push_back(read_row(measured));
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.key() < b.key(); });
  return rows;
}

std::string shown(double value) {
  if (!std::isfinite(value)) return "no number";
  return value == 0 ? "0" : fmt::format("{:.2g}", value);
}

/// A place on the axis of stress: with more digits than an error, for ranges that are narrow.
std::string place(double value) { return fmt::format("{:.4g}", value); }

/// The point with the least margin; where errors are all 0, the first one.
const Point& tightest(const Row& row) {
  const auto use = [](const Point& p) {
    return p.tolerance > 0 ? p.ours / p.tolerance : p.ours > 0 ? infinity : 0;
  };
  return *std::max_element(row.points.begin(), row.points.end(),
                           [&](const Point& a, const Point& b) { return use(a) < use(b); });
}

std::string margin_of(const Point& point) {
  if (point.ours == 0) return "exact";
  return fmt::format("{:.2g}", point.tolerance / point.ours);
}

std::string table(const std::vector<Row>& rows) {
  std::string text =
      "| case | stressed | from .. to | error of | naive error | our error | tolerance | margin |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    double least = infinity, most = -infinity, naive = 0;
    for (const Point& point : row.points) {
      least = std::min(least, point.at);
      most = std::max(most, point.at);
      if (point.naive) naive = std::max(naive, *point.naive);
    }
    const Point& worst = tightest(row);
    const std::string of_naive = row.naive.empty() ? "" : shown(naive) + ": " + row.naive;
    text += fmt::format("| {} | {} | {}: {} .. {} | {} | {} | {} | {} | {} |\n", row.id,
                        table_cell(row.stressed), table_cell(row.parameter), place(least),
                        place(most), table_cell(row.unit), table_cell(of_naive), shown(worst.ours),
                        shown(worst.tolerance), margin_of(worst));
  }
  return text;
}

/// Errors of 0 and of no number have no place on logarithmic axes.
std::vector<double> on_logarithmic_axes(double x, double y) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {x, y > 0 && std::isfinite(y) ? y : none};
}

cli::Plot plot_of(const Row& row) {
  std::vector<std::vector<double>> naive, ours, allowed;
  for (const Point& point : row.points) {
    if (point.naive) naive.push_back(on_logarithmic_axes(point.at, *point.naive));
    ours.push_back(on_logarithmic_axes(point.at, point.ours));
    allowed.push_back(on_logarithmic_axes(point.at, point.tolerance));
  }
  const auto line = [](const char* name, int type, const std::string& title, const char* dash) {
    return fmt::format("${} using 1:2 with linespoints linetype {} {} title {}", name, type, dash,
                       cli::plot_text(title));
  };
  return {.title = row.id + ": " + row.stressed,
          .script = cli::plot_data("naive", naive) + cli::plot_data("ours", ours) +
                    cli::plot_data("allowed", allowed) + "set title " +
                    cli::plot_text(row.id + ": " + row.stressed) +
                    "\nset logscale xy\nset format xy '%.0e'\nset key below\nset xlabel " +
                    cli::plot_text(row.parameter) + "\nset ylabel " + cli::plot_text(row.unit) +
                    "\nplot " + line("naive", 2, row.naive, "") + ", " +
                    line("ours", 1, "ours", "") + ", " +
                    line("allowed", 6, "tolerance", "dashtype 2 pointtype 0")};
}

const Row* find_row(const std::vector<Row>& rows, const std::string& id) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.id == id; });
  return row == rows.end() ? nullptr : &*row;
}

/// Throws where a case is missing, before anything is written.
void check_complete(const std::vector<Row>& rows, const fs::path& page) {
  std::string missing;
  for (const char* id : required)
    if (!find_row(rows, id)) missing += std::string(missing.empty() ? "" : ", ") + id;
  if (!missing.empty()) throw InputError({page.string(), {}, {}}, "nothing measured " + missing);
}

/// Draws the plots, and the lines of the page that show them.
std::string plots(const std::vector<Row>& rows, const fs::path& page, const fs::path& images) {
  std::string text;
  for (const char* id : plotted) {
    const Row* row = find_row(rows, id);
    assert(row);  // plotted cases are required
    const fs::path file = images / fmt::format("numerics-{}.svg", id);
    if (!cli::write_plot(plot_of(*row), page.parent_path() / file))
      throw OutputError({}, cli::gnuplot_missing);
    text += fmt::format("\n![{}: {} against {}]({})\n", id, row->unit, row->parameter,
                        file.generic_string());
  }
  return text;
}

}  // namespace

}  // namespace tureen::test

int main(int argc, char** argv) {
  using namespace tureen::test;
  if (argc != 4) {
    std::fprintf(stderr, "usage: numerics_report MEASURED PAGE IMAGES\n");
    return 2;
  }
  try {
    const fs::path page = argv[2];
    const std::vector<Row> rows = read_rows(argv[1]);
    check_complete(rows, page);
    write_between(page, Marks("./dev numerics"),
                  "\n" + table(rows) + plots(rows, page, argv[3]) + "\n");
    std::fprintf(stderr, "wrote %s: %zu cases\n", argv[2], rows.size());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "numerics_report: %s\n", error.what());
    return 1;
  }
}
