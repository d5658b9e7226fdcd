// Runs the built program as a user does: a child process, its two streams and its exit code.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tureen::test {

struct ChildResult {
  int exit_code = -1;  // -1 when a signal ended it
  std::string out;     // standard output
  std::string err;     // standard error
};

/// What a file holds: nothing where there is none.
std::string bytes_of_file(const std::filesystem::path& path);

/// A program that runs beside the test. Ended hard where the test forgets it.
class Child {
 public:
  /// `program`, the one that the test was built for (`tureen`) where it is empty, with these
  /// arguments, in `folder`.
  Child(const std::vector<std::string>& arguments, std::filesystem::path folder,
        const std::string& program = "");
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  /// As `kill` does: SIGINT is Ctrl-C.
  void signal(int number) const;
  /// Returns once it stands still: SIGCONT lets it go on, SIGKILL ends it where it stands.
  void stop();
  bool running();
  /// Returns once `condition` holds, the program has ended, or two minutes have passed; whether it
  /// holds.
  bool wait_until(const std::function<bool()>& condition);
  /// Whether it has opened this library, as "libOSMesa": of a context, whether that is being made.
  bool has_loaded(const std::string& library) const;
  ChildResult wait();

 private:
  std::filesystem::path folder_;
  pid_t pid_ = -1;  // -1 once it has ended
  int status_ = 0;
};

/// `tureen` with these arguments, in `folder`, to its end.
ChildResult run_tureen(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder);

}  // namespace tureen::test
