// A comparison of two results, as JSON and for people.
#pragma once

#include <string>
#include <vector>

#include "cli/report.hpp"
#include "jobs/bench/bench_comparison.hpp"

namespace tureen::cli {

/// The member `comparison` of docs/json.md; `against` is the file of the earlier result.
Json to_json(const BenchComparison& comparison, const std::string& against);

/// Lines of text, a table first; for a terminal.
std::vector<std::string> comparison_lines(const BenchComparison& comparison);

}  // namespace tureen::cli
