// The table of `tureen bench` for a terminal.
#pragma once

#include <string>
#include <vector>

#include "jobs/bench/bench_json.hpp"

namespace tureen::cli {

/// Lines of text: device and machine, loading times, then a table for each set of views and size.
/// Ratios divide min_of_medians by that of the first configuration. Ratios within the noise are
/// replaced by a verdict (ratio_text() in cli/measuring/bench_words.hpp).
std::vector<std::string> bench_table(const BenchResult& result);

}  // namespace tureen::cli
