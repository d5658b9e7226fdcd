// Starts the training of a scene from the photographs, ends it, and reports its end.
#include <algorithm>
#include <string>
#include <system_error>

#include "viewer/application.hpp"
#include "viewer/names.hpp"
#include "viewer/render_command.hpp"
#include "viewer/training_command.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

void Application::carry_out(const StartTraining& request) {
  if (!state_.photographs || training_program_) return;
  std::error_code ignored;
  const fs::path dataset = state_.photographs->path, scene = fs::absolute(request.scene, ignored);
  training_program_.emplace(tureen_program(), training_arguments(dataset, scene));
  state_.started = StartedTraining{.dataset = dataset, .scene = scene};
  state_.messages.note("The training has started. Another window will show its progress.",
                       state_.now);
}

void Application::carry_out(const StopTraining&) {
  if (!training_program_) return;
  training_program_->interrupt();
  state_.started->is_stopped = true;
}

void Application::carry_out(const CopyTrainingCommand&) {
  if (!state_.photographs) return;
  const fs::path& dataset = state_.photographs->path;
  window_.set_clipboard(quoted_command(training_arguments(dataset, new_trained_scene(dataset))));
  state_.messages.note("Copied the training command to the clipboard.", state_.now);
}

void Application::watch_training_program() {
  if (!training_program_ || !training_program_->ended()) return;
  const StartedTraining& training = *state_.started;
  const std::string name = short_name(training.scene);
  const std::string further = command_that_continues(training.dataset, training.scene);
  if (training.is_stopped)
    state_.messages.note(
        "The training of " + name + " was stopped. " +
            (further.empty() ? "It has no checkpoint." : "To continue: " + further),
        state_.now);
  else if (const auto failure = training_program_->failure())
    state_.messages.error("The training of " + name + " failed", *failure, state_.now);
  else
    state_.messages.note("The training of " + name + " has ended.", state_.now);
  training_program_.reset();
  state_.started.reset();
  state_.asks_before_quitting = false;
  frames_wanted_ = std::max(frames_wanted_, 2);
}

}  // namespace tureen::viewer
