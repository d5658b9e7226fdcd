// Commands to a run in progress, through a file of one word beside the run's log. The window writes
// it, and the run reads it between two steps. It exists while the run is in progress.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <thread>

namespace tureen::trainer {

enum class RunCommand {
  run,
  pause,
  finish,  // end after the next step, as if it were the last of the schedule
};

/// OUT.control for the log OUT.jsonl.
std::filesystem::path control_file(const std::filesystem::path& log);

/// The last command; nullopt without a run in progress, or if the file cannot be read.
std::optional<RunCommand> read_command(const std::filesystem::path& file);

/// Throws UsageError without a run in progress, and OutputError if the file cannot be written.
void send_command(const std::filesystem::path& file, RunCommand command);

/// The time of a run; tests replace both functions.
struct RunClock {
  std::function<std::chrono::steady_clock::time_point()> now = &std::chrono::steady_clock::now;
  std::function<void(std::chrono::milliseconds)> sleep = [](std::chrono::milliseconds time) {
    std::this_thread::sleep_for(time);
  };
};

/// The run's side.
class RunControl {
 public:
  /// Creates `file`, or takes over the one of a killed run. Throws UsageError if another kind of
  /// file is there, and OutputError if the file cannot be written.
  explicit RunControl(std::filesystem::path file, RunClock clock = {});
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;
  /// Removes the file.
  ~RunControl();

  /// The last command. Reads the file at most ten times a second, so it can be called between all
  /// steps. A file without a command changes nothing; a missing file means `run`.
  RunCommand command();

  /// Returns when the command is not, or no longer, `pause`. Calls `waiting` ten times a second
  /// while it is, and passes on its exceptions. Returns the seconds of the pause.
  double wait_while_paused(const std::function<void()>& waiting);

 private:
  std::filesystem::path file_;
  RunClock clock_;
  RunCommand last_ = RunCommand::run;
  std::chrono::steady_clock::time_point next_ = {};
};

}  // namespace tureen::trainer
