// `tureen bench --import`: what bench.html measured in browsers, told as `tureen bench` tells what
// it measures itself.
#pragma once

#include <string>
#include <vector>

#include "cli/bench_reports.hpp"
#include "cli/exit_code.hpp"

namespace tureen::cli {

struct BenchImport {
  std::vector<std::string> files;  // one a device, at least one
  BenchReportOptions reports;
};

/// Reads all files before it says or writes anything. Where they hold one scene, the reports are
/// those of one run; where they hold several, each gets a folder of its own within that of the
/// reports, --csv all of them in one table, and --json a list. Several files are put side by side
/// in a table, too. Throws InputError, UsageError (--against with several scenes) and OutputError.
ExitCode import_benches(const BenchImport& import);

}  // namespace tureen::cli
