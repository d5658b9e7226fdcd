#include "viewer/files/followed_training.hpp"

#include <utility>

#include "base/error.hpp"

namespace tureen::viewer {

FollowedTraining::FollowedTraining(const std::filesystem::path& log)
    : control_(trainer::control_file(log)), log_(log) {}

bool FollowedTraining::update() {
  const auto command = trainer::read_command(control_);
  bool changed = command != std::exchange(command_, command);
  try {
    if (!log_.update()) return changed;
    problem_.clear();
  } catch (const InputError& error) {
    problem_ = error.what();
  }
  return true;
}

void FollowedTraining::send(trainer::RunCommand command) {
  trainer::send_command(control_, command);
  command_ = command;
}

}  // namespace tureen::viewer
