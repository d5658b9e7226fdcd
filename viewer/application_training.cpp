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
  const FileTime scene_before = time_of(scene);
  training_program_.emplace(tureen_program(),
                            training_arguments(dataset, scene, request.start, request.choice));
  state_.started = StartedTraining{.dataset = dataset,
                                   .scene = scene,
                                   .start = request.start,
                                   .choice = request.choice,
                                   .scene_before = scene_before};
  state_.note("The training has started. Another window will show its progress.");
}

void Application::carry_out(const StopTraining&) {
  if (!training_program_) return;
  StartedTraining& training = *state_.started;
  const FileTime before = time_of(checkpoint_of(training.scene));
  if (training.is_stopped || !training_program_->interrupt()) return;
  training.checkpoint_before = before;
  training.is_stopped = true;
}

void Application::carry_out(const MeasureTraining&) {
  if (state_.training_seconds) return;
  const auto work = [this](const Worker::Progress&) {
    const double seconds = measured_seconds_per_pixel(0);
    return Worker::Completion([this, seconds] { state_.training_seconds = seconds; });
  };
  worker_.start({.kind = JobKind::forecast,
                 .what = "measuring the speed of training",
                 .work = work,
                 .failed = [](const std::string&) {}});  // then there is no forecast
}

void Application::carry_out(const CopyTrainingCommand&) {
  if (!state_.photographs) return;
  const fs::path& dataset = state_.photographs->path;
  const auto& started = state_.started;
  window_.set_clipboard(quoted_command(
      started && started->dataset == dataset
          ? training_arguments(dataset, started->scene, started->start, started->choice)
          : training_arguments(dataset, new_trained_scene(dataset))));
  state_.note("Copied the training command to the clipboard.");
}

void Application::watch_training_program() {
  if (!training_program_ || !training_program_->ended()) return;
  const StartedTraining& training = *state_.started;
  const FileTime scene = time_of(training.scene),
                 checkpoint = time_of(checkpoint_of(training.scene));
  const EndedTraining ended{
      .dataset = training.dataset,
      .scene = training.scene,
      .is_stopped = training.is_stopped,
      .wrote_scene = scene && scene != training.scene_before,
      .wrote_checkpoint = checkpoint && checkpoint != training.checkpoint_before,
      .failure = training_program_->failure()};
  if (const std::string note = note_of(ended); !note.empty())
    state_.note(note);
  else
    state_.error("The training of " + short_name(training.scene) + " failed", *ended.failure);
  training_program_.reset();
  state_.started.reset();
  state_.asks_before_quitting = false;
  frames_wanted_ = std::max(frames_wanted_, 2);
}

}  // namespace tureen::viewer
