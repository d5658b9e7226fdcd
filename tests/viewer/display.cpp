#include "tests/viewer/display.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>

namespace tureen::test {

Display::Display() {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("cannot create a pipe");
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("cannot create a process");
  if (pid_ == 0) {
    // The server chooses a free display number and writes it here, so parallel tests do not
    // collide.
    const std::string descriptor = std::to_string(ends[1]);
    // Without -noreset it restarts when the last window closes, and meanwhile refuses the next one.
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDERR_FILENO);
    ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1600x1200x24",
             "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(ends[1]);
  std::string number;
  for (char letter = 0; ::read(ends[0], &letter, 1) == 1 && letter != '\n';) number += letter;
  ::close(ends[0]);
  if (number.empty()) throw std::runtime_error("Xvfb did not start; install xvfb");
  ::setenv("DISPLAY", (":" + number).c_str(), 1);
}

Display::~Display() {
  ::kill(pid_, SIGTERM);
  ::waitpid(pid_, nullptr, 0);
}

}  // namespace tureen::test
