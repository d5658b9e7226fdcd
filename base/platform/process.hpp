// Programs that this one starts; no other code starts any. No shell is involved. Needs POSIX: not
// available in a browser or on Windows.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tureen {

/// A program that was started. It continues when this object is destroyed, unless it ends with us.
class Process {
 public:
  /// Its standard input: that of this program, none, or the bytes from send().
  enum class Input { inherited, none, sent };
  struct Options {
    Input input = Input::inherited;
    /// The streams that it writes to. nullptr: the text is discarded.
    std::FILE* output = stdout;
    std::FILE* errors = stderr;
    /// Its output goes to receive() instead of `output`.
    bool received = false;
    /// In a group of its own, Ctrl-C in the terminal does not reach it, and the signals below also
    /// reach the programs that it has started.
    bool own_group = false;
    /// Is killed with this object and with the thread that starts it; on Linux, by setpriv.
    bool ends_with_us = false;
  };

  /// `program`: a path, or a name that is searched on PATH. Throws std::system_error with the
  /// system's reason.
  Process(const std::string& program, const std::vector<std::string>& arguments,
          const Options& options);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  /// Closes its input, and our end of its output.
  ~Process();

  /// Blocks while the program reads nothing. Returns false if it has closed its input. Asserts
  /// Input::sent.
  bool send(std::span<const std::byte> bytes);

  /// Fills `bytes` with its output; blocks meanwhile. Returns the number of bytes, which is smaller
  /// only at the end of the output. Asserts Options::received.
  std::size_t receive(std::span<std::byte> bytes);

  bool ended();
  /// Closes its input and waits for its end. Returns the exit code, 128 + N if signal N ended it.
  int wait();

  /// Interrupts it, as Ctrl-C does. Returns whether it was still running.
  bool interrupt();
  /// Interrupts it and waits for its end. After `patience` terminates it, after the same time again
  /// kills it.
  void end(std::chrono::milliseconds patience);
  /// Ends it at once and waits for its end.
  void kill();

 private:
  bool send_signal(int signal);
  bool notice_end(bool waits);
  void close_input();

  int process_ = -1;
  bool own_group_ = false, ends_with_us_ = false;
  int input_ = -1, output_ = -1;  // our ends of connections
  std::optional<int> exit_code_;
};

/// Replaces this process by a program. Throws std::system_error if it cannot be started.
[[noreturn]] void become_program(const std::string& program,
                                 const std::vector<std::string>& arguments);

/// The output of a program; empty if it fails or does not exist. Its errors are discarded.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments);

/// Whether a folder of PATH has a program with this name.
bool is_on_path(const std::string& program);

/// The text for a POSIX shell: unchanged if it has only plain characters, otherwise in single
/// quotes.
std::string shell_word(const std::string& text);

}  // namespace tureen
