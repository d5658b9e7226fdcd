// The options of `tureen bench` that select the cases.
#pragma once

#include <string>
#include <vector>

#include "cli/options/arguments.hpp"
#include "cli/options/drawing_options.hpp"

namespace tureen::cli {

struct BenchCaseArguments {
  DrawingOptions drawing;
  std::vector<std::string> only;  // names of cases; empty: the default cases
  bool ceilings = false;
};

/// --only, --ceilings and the drawing options that all commands share.
void add_case_options(Command& command, BenchCaseArguments& options);

/// Throws UsageError for unknown names.
void check(const BenchCaseArguments& options);

}  // namespace tureen::cli
