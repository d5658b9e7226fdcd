// An X server that draws into memory (Xvfb), for tests with windows.
#pragma once

#include <sys/types.h>

#include <string>

namespace tureen::test {

class Display {
 public:
  /// Starts a server and sets DISPLAY to it. Throws std::runtime_error if it cannot be started.
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

 private:
  pid_t pid_ = -1;
};

}  // namespace tureen::test
