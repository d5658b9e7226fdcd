// Root ignores permissions, and tests in containers run as root: these tests run as another user.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace tureen::test {

/// While it exists, new children run as user 65534 if the test runs as root. Their real user
/// changes, too: a program with different real and effective users may not be traced, not even by
/// itself, and the leak checker traces it.
class Nobody {
 public:
  Nobody() : was_root_(::geteuid() == 0) {
    // The saved user stays root, so that the destructor can restore it.
    if (was_root_ && (::setreuid(nobody, 0) != 0 || ::seteuid(nobody) != 0))
      throw std::runtime_error("cannot change the user from root");
  }
  Nobody(const Nobody&) = delete;
  Nobody& operator=(const Nobody&) = delete;
  ~Nobody() {
    if (was_root_ && (::seteuid(0) != 0 || ::setreuid(0, 0) != 0)) std::abort();
  }

 private:
  static constexpr uid_t nobody = 65534;
  bool was_root_;
};

/// Creates the files in `folder` for the output of children (child.cpp), writable for every user.
inline void make_streams_for_all(const std::filesystem::path& folder) {
  for (const char* stream : {"stdout.txt", "stderr.txt"}) {
    const std::ofstream made(folder / stream, std::ios::app);
    std::filesystem::permissions(folder / stream, std::filesystem::perms(0666));
  }
}

}  // namespace tureen::test
