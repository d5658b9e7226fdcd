// The program's exit codes. Scripts rely on them: ARCHITECTURE.md has the table.
#pragma once

namespace tureen::cli {

enum class ExitCode {
  done = 0,
  check_failed = 1,  // a limit is exceeded, or lint has findings with --strict
  usage = 2,
  bad_input = 3,
  no_context = 4,
  other = 5,
};

}  // namespace tureen::cli
