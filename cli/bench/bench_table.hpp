// What `tureen bench` says on the terminal.
#pragma once

#include <string>
#include <vector>

#include "jobs/results/bench_json.hpp"

namespace tureen::cli {

/// Lines: where it ran, what loading cost, then a table for each set of views and size. Ratios are
/// of min_of_medians and refer to the first configuration; ratio_text() (cli/bench/bench_words.hpp)
/// says where they mean nothing.
std::vector<std::string> bench_table(const BenchResult& result);

}  // namespace tureen::cli
