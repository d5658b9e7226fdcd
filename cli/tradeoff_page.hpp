// The report of `tureen tradeoff` as one HTML page that needs nothing beside it.
#pragma once

#include <string>
#include <vector>

#include "cli/figures.hpp"
#include "cli/tradeoff_report.hpp"

namespace tureen::cli {

/// What was measured, the choice, the figures (none where gnuplot is missing) and the tables.
std::string tradeoff_page(const TradeoffReport& report, const std::vector<DrawnFigure>& figures);

}  // namespace tureen::cli
