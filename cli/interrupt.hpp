// Ctrl-C, SIGTERM and SIGHUP as an exception at the next safe point, so that temporary files are
// removed on the way out. A second signal ends the program at once.
#pragma once

#include <stdexcept>

namespace tureen::cli {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

void catch_interrupts();

/// Throws Interrupted once a signal has come. Long loops call it.
void throw_if_interrupted();

}  // namespace tureen::cli
