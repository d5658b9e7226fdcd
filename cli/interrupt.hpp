// Ctrl-C, SIGTERM and SIGHUP as an exception at the next safe point, so that temporary files are
// removed on the way out. A second signal ends the program at once.
#pragma once

#include <stdexcept>

namespace tureen::cli {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// From now on the signals are noted, but for those that whoever started us ignores (nohup).
void catch_interrupts();

/// Writing where nobody reads any more (a pipe to `head`) is an error of that write alone from now
/// on, not the end of the program.
void outlive_readers();

/// Throws Interrupted once a signal has come. Long loops call it.
void throw_if_interrupted();

}  // namespace tureen::cli
