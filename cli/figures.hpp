// Plots of a report as files of their own, and as what its page holds.
#pragma once

#include <filesystem>
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
};

/// Draws each figure into `folder`, which is there, as SVG for pages and as PNG for slides, and
/// appends the files to `written`. Returns none where gnuplot is missing. Throws OutputError, and
/// what throw_if_interrupted() throws.
std::vector<DrawnFigure> write_figures(std::span<const Figure> figures,
                                       const std::filesystem::path& folder,
                                       std::vector<std::string>& written);

}  // namespace tureen::cli
