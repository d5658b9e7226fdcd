// The result of `tureen tradeoff` as tables for a terminal.
#pragma once

#include <string>

#include "jobs/tradeoff/tradeoff_json.hpp"

namespace tureen::cli {

using results::TradeoffReport;

/// The reference for edits in words: "at the device's sample points" or "with exact triangles".
const char* where_it_looks(const TradeoffReport& report);

/// Prints the tables, skipped configurations, warnings, the front and the choice.
void say_tables(const TradeoffReport& report);

/// A sentence with the choice, or with the limits that no configuration meets.
std::string choice_sentence(const TradeoffReport& report);

}  // namespace tureen::cli
