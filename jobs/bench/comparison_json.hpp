// A comparison of two benchmark results as JSON, and its sentences.
#pragma once

#include <string>
#include <vector>

#include "base/json/json_text.hpp"
#include "jobs/bench/bench_comparison.hpp"

namespace tureen::results {

/// The member `comparison` of docs/json.md; `against` is the file of the earlier result.
Json to_json(const BenchComparison& comparison, const std::string& against);

/// Sentences: the reason if the results are not compared, and one for each BenchChange.
std::vector<std::string> circumstances(const BenchComparison& comparison);

/// A line for each measurement that only one of the results has.
std::vector<std::string> unmatched_lines(const BenchComparison& comparison);

}  // namespace tureen::results
