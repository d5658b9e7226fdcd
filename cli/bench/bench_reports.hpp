// The output files of `tureen bench`, and its comparison with an earlier result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/options/arguments.hpp"
#include "jobs/bench/bench_comparison.hpp"
#include "jobs/bench/bench_json.hpp"

namespace tureen::cli {

/// As typed; empty if not given.
struct BenchReportOptions {
  std::string folder;   // for report.html, bench.json and the images
  std::string against;  // an earlier bench.json
  std::optional<double> fail_slower;
  bool json = false;  // the result on standard output
};

/// A comparison for a terminal: a table, then circumstances() and unmatched_lines().
std::vector<std::string> comparison_lines(const BenchComparison& comparison);

/// --output, --against, --fail-slower and --json.
void add_bench_report_options(Command& command, BenchReportOptions& options);

/// Call this before anything is measured. Reads the result of --against, so that an invalid file is
/// reported at once, and creates the folder. Throws UsageError if an output would replace that file
/// or one of `inputs`, the files and folders that are read. Throws InputError and OutputError.
std::optional<BenchResult> prepare_bench_reports(const BenchReportOptions& options,
                                                 std::vector<std::string> inputs);

/// Writes the files, each completely or not at all. Prints their names and the changes since
/// `then`. Returns ExitCode::check_failed if --fail-slower was given and a row is slower than it
/// allows or cannot be checked. Throws OutputError.
ExitCode report_bench(const BenchReportOptions& options, const BenchResult& now,
                      const std::optional<BenchResult>& then);

}  // namespace tureen::cli
