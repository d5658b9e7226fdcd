// The report of `tureen tradeoff` as one HTML page that needs nothing beside it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/tradeoff_report.hpp"

namespace tureen::cli {

/// SVGs of draw_plot(), and a caption each.
using Drawings = std::vector<std::pair<std::string, std::string>>;

/// What was measured, the choice, the plots (none where gnuplot is missing) and the tables.
std::string tradeoff_page(const TradeoffReport& report, const Drawings& drawings);

}  // namespace tureen::cli
