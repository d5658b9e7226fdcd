// Ctrl-C, SIGTERM and SIGHUP as an exception at the next safe point, so that temporary files are
// removed on the way out. A second signal ends the program at once.
#pragma once

#include <stdexcept>

namespace tureen::cli {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Starts to record the signals. Signals that the parent process ignores (nohup) stay ignored.
void catch_interrupts();

/// From now on, a write to a closed pipe (such as `| head`) only fails and does not end the
/// program.
void outlive_readers();

/// Throws Interrupted after a signal. Long loops call it.
void throw_if_interrupted();

}  // namespace tureen::cli
