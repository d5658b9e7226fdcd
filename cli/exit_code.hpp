// What the program's exit code says. Scripts rely on it: ARCHITECTURE.md has the table.
#pragma once

#include <exception>

namespace tureen::cli {

enum class ExitCode {
  done = 0,
  check_failed = 1,  // the comparison is past its tolerance, lint found something under --strict
  usage = 2,
  bad_input = 3,
  no_context = 4,
  other = 5,
};

/// The code for what was thrown.
ExitCode exit_code_of(const std::exception& error);

}  // namespace tureen::cli
