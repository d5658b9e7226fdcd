// The result of `tureen tradeoff` as tables for a terminal.
#pragma once

#include <string>

#include "jobs/results/tradeoff_json.hpp"

namespace tureen::cli {

using results::TradeoffReport;

/// The reference of drawing settings, in words: "at the device's own sample points".
const char* where_it_looks(const TradeoffReport& report);

/// The tables for a terminal, with what was skipped, the rules, the front and the choice.
void say_tables(const TradeoffReport& report);

/// The choice in a sentence, or why there is none.
std::string choice_sentence(const TradeoffReport& report);

}  // namespace tureen::cli
