#include "cli/interrupt.hpp"

#include <csignal>

namespace tureen::cli {

namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_signal(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

void throw_if_interrupted() {
  if (interrupted) throw Interrupted();
}

}  // namespace tureen::cli
