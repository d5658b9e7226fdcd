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

/// The bytes of a file; empty if it does not exist.
std::string bytes_of_file(const std::filesystem::path& path);

/// A program that runs beside the test. The destructor kills it.
class Child {
 public:
  /// Starts `program` with these arguments in `folder`. An empty `program` is `tureen`, as the test
  /// was built with it.
  Child(const std::vector<std::string>& arguments, std::filesystem::path folder,
        const std::string& program = "");
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  /// Sends a signal, as `kill` does: SIGINT is Ctrl-C.
  void signal(int number) const;
  /// Stops the child, and returns once it is stopped. SIGCONT continues it, SIGKILL ends it.
  void stop();
  bool running();
  /// Returns once `condition` is true, the program has ended, or two minutes have passed. Returns
  /// the value of `condition`.
  bool wait_until(const std::function<bool()>& condition);
  /// Whether it has opened this library. With "libOSMesa", it is creating a context or has one.
  bool has_loaded(const std::string& library) const;
  ChildResult wait();

 private:
  std::filesystem::path folder_;
  pid_t pid_ = -1;  // -1 once it has ended
  int status_ = 0;
};

/// Runs `tureen` with these arguments in `folder`, and waits for its end.
ChildResult run_tureen(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder);

}  // namespace tureen::test
