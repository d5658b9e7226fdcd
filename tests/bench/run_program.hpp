// The main function of the programs that measure.
#pragma once

#include <cstdio>
#include <exception>

namespace tureen::test {

/// Returns run(argc, argv), or prints the error after the program's name and returns 1.
template <class Run>
int run_program(const char* name, Run&& run, int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 1;
  }
}

}  // namespace tureen::test
