// The report of `tureen tradeoff` as one HTML page that needs nothing beside it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/tradeoff_report.hpp"

namespace tureen::cli {

/// What was measured, the choice, the plots (SVG and caption; none where gnuplot is missing) and
/// the tables.
std::string tradeoff_page(const TradeoffReport& report,
                          const std::vector<std::pair<std::string, std::string>>& drawings);

}  // namespace tureen::cli
