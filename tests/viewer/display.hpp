// An X server that draws into memory (Xvfb), for tests that open windows.
#pragma once

#include <sys/types.h>

#include <string>

namespace tureen::test {

class Display {
 public:
  /// Starts a server and names it in DISPLAY. Throws std::runtime_error where there is none.
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

 private:
  pid_t pid_ = -1;
};

}  // namespace tureen::test
