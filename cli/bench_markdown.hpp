// A result of `tureen bench` as Markdown, to be put into documents.
#pragma once

#include <string>

#include "cli/bench_result.hpp"

namespace tureen::cli {

/// A sentence on where it was measured, then a table: a measurement a row, ratios to
/// reference_configuration().
std::string bench_markdown(const BenchResult& result);

}  // namespace tureen::cli
