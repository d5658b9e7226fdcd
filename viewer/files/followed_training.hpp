// A run of `tureen train` that the window follows by its files: it reads the log, and reads and
// writes the run's control file. It works for every training method.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trainer/common/run_control.hpp"
#include "trainer/common/training_log.hpp"

namespace tureen::viewer {

class FollowedTraining {
 public:
  explicit FollowedTraining(const std::filesystem::path& log);

  /// Reads both files. Returns whether anything has changed.
  bool update();

  /// Throws the errors of trainer::send_command.
  void send(trainer::RunCommand command);

  const std::vector<trainer::TrainingRecord>& records() const { return log_.records(); }
  /// What the run will do, as lines; empty if the log does not say.
  const std::vector<std::string>& plan() const { return log_.plan(); }
  /// The last command; nullopt while no run is in progress.
  const std::optional<trainer::RunCommand>& command() const { return command_; }
  /// Why the log, or its end, cannot be read; empty if it can.
  const std::string& problem() const { return problem_; }

 private:
  std::filesystem::path control_;
  trainer::TrainingLogTail log_;
  std::optional<trainer::RunCommand> command_;
  std::string problem_;
};

}  // namespace tureen::viewer
