// Permissions stop nobody who is root, as tests in containers are: they are tried as somebody else.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace tureen::test {

/// Children that start meanwhile are nobody's where the test is root's, whom no permission stops.
class Nobody {
 public:
  Nobody() : was_root_(::geteuid() == 0) {
    if (was_root_ && ::seteuid(65534) != 0) throw std::runtime_error("root cannot be nobody");
  }
  Nobody(const Nobody&) = delete;
  Nobody& operator=(const Nobody&) = delete;
  ~Nobody() {
    if (was_root_ && ::seteuid(0) != 0) std::abort();
  }

 private:
  bool was_root_;
};

/// The files in `folder` that take what children say (child.cpp), for everybody to write.
inline void make_streams_for_all(const std::filesystem::path& folder) {
  for (const char* stream : {"stdout.txt", "stderr.txt"}) {
    std::ofstream(folder / stream, std::ios::app);
    std::filesystem::permissions(folder / stream, std::filesystem::perms(0666));
  }
}

}  // namespace tureen::test
