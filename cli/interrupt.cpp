#include "cli/interrupt.hpp"

#include <csignal>

namespace tureen::cli {

namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_signal(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

/// What whoever started us has ignored, as nohup does, stays ignored.
void note_unless_ignored(int signal) {
  if (std::signal(signal, note_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace

void catch_interrupts() {
  note_unless_ignored(SIGINT);
  note_unless_ignored(SIGTERM);
#ifdef SIGHUP
  note_unless_ignored(SIGHUP);  // a session that was lost
#endif
#ifdef SIGXFSZ
  // A file that grows past its limit is an error of the write, which says so, not the end.
  std::signal(SIGXFSZ, SIG_IGN);
#endif
}

void outlive_readers() {
#ifdef SIGPIPE
  std::signal(SIGPIPE, SIG_IGN);
#endif
}

void throw_if_interrupted() {
  if (interrupted) throw Interrupted();
}

}  // namespace tureen::cli
