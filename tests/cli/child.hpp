// Runs the built program as a user does: a child process, its two streams and its exit code.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tureen::test {

struct ChildResult {
  int exit_code = -1;  // -1 when a signal ended it
  std::string out;     // standard output
  std::string err;     // standard error
};

/// `tureen` with these arguments, in `folder`.
ChildResult run_tureen(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder);

}  // namespace tureen::test
