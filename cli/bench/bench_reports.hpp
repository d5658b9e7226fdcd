// The files that `tureen bench` leaves beside its table, and what it says of an earlier result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/options/arguments.hpp"
#include "jobs/results/bench_json.hpp"

namespace tureen::cli {

/// As typed; empty where not given.
struct BenchReportOptions {
  std::string folder;   // for report.html, bench.json and the images timed
  std::string against;  // an earlier bench.json
  std::optional<double> fail_slower;
  bool json = false;  // the result on standard output
};

/// --output, --against, --fail-slower and --json.
void add_bench_report_options(Command& command, BenchReportOptions& options);

/// To be called before anything is measured: reads what --against names, so that a bad file is
/// refused at once, and makes the folder. No file takes the place of that one or of `inputs`,
/// files and folders that are read. Throws InputError, UsageError and OutputError.
std::optional<BenchResult> prepare_bench_reports(const BenchReportOptions& options,
                                                 std::vector<std::string> inputs);

/// Writes the files, each complete or not at all, prints their names, and what changed since
/// `then`. ExitCode::check_failed only where --fail-slower was given and something is slower than
/// that. Throws OutputError.
ExitCode report_bench(const BenchReportOptions& options, const BenchResult& now,
                      const std::optional<BenchResult>& then);

}  // namespace tureen::cli
