// Permissions stop nobody who is root, as tests in containers are: they are tried as somebody else.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace tureen::test {

/// Children that start meanwhile are nobody's where the test is root's, whom no permission stops.
/// Theirs is the real user too: a program whose real and effective users differ may not be traced,
/// not even by itself, and a leak checker has to.
class Nobody {
 public:
  Nobody() : was_root_(::geteuid() == 0) {
    // The saved user stays root, to come back by.
    if (was_root_ && (::setreuid(nobody, 0) != 0 || ::seteuid(nobody) != 0))
      throw std::runtime_error("root cannot be nobody");
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

/// The files in `folder` that take what children say (child.cpp), for everybody to write.
inline void make_streams_for_all(const std::filesystem::path& folder) {
  for (const char* stream : {"stdout.txt", "stderr.txt"}) {
    const std::ofstream made(folder / stream, std::ios::app);
    std::filesystem::permissions(folder / stream, std::filesystem::perms(0666));
  }
}

}  // namespace tureen::test
