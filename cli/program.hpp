// The whole program as a function: parses arguments, runs a subcommand, and reports exceptions as a
// sentence on standard error and an exit code.
#pragma once

namespace tureen::cli {

int run_program(int argc, char** argv);

}  // namespace tureen::cli
