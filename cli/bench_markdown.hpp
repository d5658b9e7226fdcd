// A result of `tureen bench` as Markdown, to be put into documents.
#pragma once

#include <string>

#include "cli/bench_comparison.hpp"
#include "cli/bench_result.hpp"

namespace tureen::cli {

/// A sentence on where it was measured, then a table: a measurement a row, ratios to
/// reference_configuration(), and under it what marks mean.
std::string bench_markdown(const BenchResult& result);

/// How it differs from an earlier one, `against`: a table, and below it the sentences.
std::string comparison_markdown(const BenchComparison& comparison, const std::string& against);

/// As the text of a cell: what would end it is escaped.
std::string markdown_cell(const std::string& text);

}  // namespace tureen::cli
