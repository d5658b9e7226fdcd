// Plots of a report as files of their own, and as what its page holds.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/gnuplot.hpp"

namespace tureen::cli {

struct Figure {
  std::string file;  // without an extension: "drawing"; different for every figure of a report
  std::string caption;
  Plot plot;
};

struct DrawnFigure {
  std::string svg;  // of draw_plot()
  std::string caption;
  std::vector<std::string> files{};  // that it was written to
};

/// Draws each figure into `folder`, which is there, as SVG for pages and as PNG for slides. Nothing
/// where gnuplot is missing. Throws OutputError, and what throw_if_interrupted() throws.
std::optional<std::vector<DrawnFigure>> write_figures(std::span<const Figure> figures,
                                                      const std::filesystem::path& folder);

/// The files of all of them, in order.
std::vector<std::string> files_of(std::span<const DrawnFigure> figures);

}  // namespace tureen::cli
