// Plots of `tureen tradeoff` as files, and as what its pages hold.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/tradeoff_page.hpp"
#include "cli/tradeoff_plots.hpp"

namespace tureen::cli {

/// Draws each plot into `folder`, which is there, as SVG and as PNG; appends the files to `output`,
/// and to `notes` where gnuplot is missing: then there are no drawings. Throws OutputError, and
/// what throw_if_interrupted() throws.
Drawings write_plots(std::span<const TradeoffPlot> plots, const std::filesystem::path& folder,
                     std::vector<std::string>& output, std::vector<std::string>& notes);

}  // namespace tureen::cli
