#include "cli/interrupt.hpp"

#include <csignal>

namespace tureen::cli {

namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_signal(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

/// Signals that the parent process ignores, as nohup does, stay ignored.
void note_unless_ignored(int signal) {
  if (std::signal(signal, note_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace

void catch_interrupts() {
  note_unless_ignored(SIGINT);
  note_unless_ignored(SIGTERM);
#ifdef SIGHUP
  note_unless_ignored(SIGHUP);  // the terminal or connection was closed
#endif
#ifdef SIGXFSZ
  // A write beyond the file size limit then fails with an error and does not end the program.
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
