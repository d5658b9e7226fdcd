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
#ifdef SIGHUP
  std::signal(SIGHUP, note_signal);  // a session that was lost
#endif
#ifdef SIGXFSZ
  // A file that grows past its limit is an error of the write, which says so, not the end.
  std::signal(SIGXFSZ, SIG_IGN);
#endif
}

void throw_if_interrupted() {
  if (interrupted) throw Interrupted();
}

}  // namespace tureen::cli
