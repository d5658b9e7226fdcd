// A program that the window starts and does not wait for, such as `tureen train`. It goes on when
// the window is closed.
#pragma once

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/platform/process.hpp"

namespace tureen::viewer {

class BackgroundProgram {
 public:
  /// `program`: a path, or a name that is searched on PATH. Its standard output is discarded.
  /// Throws OutputError with the program if it cannot be started.
  BackgroundProgram(std::string program, const std::vector<std::string>& arguments);

  /// Whether it has ended.
  bool ended() { return process_->ended(); }
  /// Interrupts it and the programs that it has started, as Ctrl-C in a terminal does. Returns
  /// whether it was still running.
  bool interrupt() { return process_->interrupt(); }
  /// Interrupts it and waits for its end. After `patience` terminates it, after the same time again
  /// kills it.
  void end(std::chrono::milliseconds patience = std::chrono::seconds(5)) {
    process_->end(patience);
  }
  /// The last line of its errors, if it has ended with an exit code other than 0.
  std::optional<std::string> failure();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string program_;
  std::unique_ptr<std::FILE, Close> errors_;  // a file without a name
  std::optional<Process> process_;            // never empty
};

/// Runs a program that writes `output` to its end. Calls `check` 20 times a second; if it throws,
/// ends the program and passes on the exception. Throws OutputError with the program if it cannot
/// be started, and with `output` and the last line of the program's errors if it fails.
void run_to_end(const std::string& program, const std::vector<std::string>& arguments,
                const std::filesystem::path& output, const std::function<void()>& check);

/// The program `tureen`: the path beside this one, otherwise the name alone.
std::string tureen_program();

}  // namespace tureen::viewer
