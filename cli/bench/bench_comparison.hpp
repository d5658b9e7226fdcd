// Formats a comparison of two results for a terminal.
#pragma once

#include <string>
#include <vector>

#include "jobs/bench/bench_comparison.hpp"

namespace tureen::cli {

/// Lines of text: a table, then circumstances() and unmatched_lines().
std::vector<std::string> comparison_lines(const BenchComparison& comparison);

}  // namespace tureen::cli
