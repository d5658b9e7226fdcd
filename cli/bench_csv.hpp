// A result of `tureen bench` as a table for spreadsheets and scripts.
#pragma once

#include <span>
#include <string>

#include "cli/bench_result.hpp"

namespace tureen::cli {

/// RFC 4180 with lines that end in LF: a line of names, then a measurement a line. Every line says
/// on what it was measured, so that tables of several runs can be put together. Units are in the
/// names; what was not measured, or is not known of so few samples, is empty. Columns are only ever
/// added, at the end.
std::string bench_csv(std::span<const BenchResult> results);
inline std::string bench_csv(const BenchResult& result) { return bench_csv(std::span(&result, 1)); }

}  // namespace tureen::cli
