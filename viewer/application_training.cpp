// Finds the cameras of photographs without; starts the training of a scene from photographs, ends
// it, and reports its end.
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/decimal_text.hpp"
#include "jobs/cameras/camera_run.hpp"
#include "viewer/application.hpp"
#include "viewer/names.hpp"
#include "viewer/render_command.hpp"
#include "viewer/training_command.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& each : sentences) text += (text.empty() ? "" : " ") + each;
  return text;
}

/// Why the cameras cannot be trusted, and the command that uses them anyway.
std::string refusal(const CameraOptions& job, const CameraQuality& quality) {
  const std::string reasons = joined(described(quality.refusals));
  if (quality.registered == 0) return reasons.empty() ? "COLMAP placed no camera." : reasons;
  return reasons + " To write it anyway, run: " +
         quoted_command(
             {"cameras", job.photographs.string(), "-o", job.dataset.string(), "--accept"});
}

}  // namespace

void Application::ask_about_photographs(const fs::path& path) {
  std::error_code ignored;
  fs::path dataset = (fs::absolute(path, ignored).lexically_normal() / "").parent_path();
  if (!fs::is_directory(path, ignored)) dataset.replace_extension();
  dataset += ".dataset";
  const auto work = [this, path, dataset](const Worker::Progress&) {
    const bool is_known = has_cameras({.photographs = path, .dataset = dataset});
    return Worker::Completion([this, path, dataset, is_known] {
      if (is_known)
        state_.ask(OpenPhotographs{.path = dataset, .trains = true});
      else
        state_.camera_search = {path, dataset.string()};
    });
  };
  const auto failed = [this, path](const std::string& reason) {
    state_.error(short_name(path) + " cannot be read", reason, Message::About::opening);
  };
  worker_.start({.kind = JobKind::photographs,
                 .what = "looking for the cameras of " + short_name(path),
                 .work = work,
                 .failed = failed});
}

void Application::carry_out(const OfferTraining& request) {
  if (!state_.photographs) return;
  if (training_program_) return state_.note("A training is already running.");
  if (request.is_for_photographs) {
    TrainingChoice& choice = state_.training_choice;
    for (const TrainingMethodInfo* method : training_methods())
      if (method->name == std::string_view("gaussians")) choice.method = method;
    choice.values["minutes"] = "15";
    const double scale = moderate_scale(state_.photographs->full.cameras);
    choice.scale = scale < 1 ? short_decimal(scale, 4) : "";
    choice.scale_is_preset = true;
  } else if (std::exchange(state_.training_choice.scale_is_preset, false)) {
    state_.training_choice.scale.clear();  // it was that of other photographs
  }
  state_.scene_to_train = new_trained_scene(state_.photographs->path).string();
  measure_training();
}

void Application::carry_out(const FindCameras& request) {
  if (searcher_.status())
    return state_.note("A search for cameras is already running. Cancel it first.");
  const CameraOptions job{.photographs = request.photographs, .dataset = request.dataset};
  const auto work = [this, job](const Worker::Progress& progress) {
    const CameraEvents events{
        .progress = [&](const char*, double fraction, double) { progress(fraction); },
        .note = [](const std::string&) {}};  // the outcome has all remarks
    const auto outcome = std::make_shared<const CameraOutcome>(find_cameras(job, events));
    return Worker::Completion([this, job, outcome] {
      const CameraQuality& quality = outcome->quality;
      if (!outcome->is_written) {
        state_.error("The photographs of " + short_name(job.photographs) + " have no cameras",
                     refusal(job, quality));
        return;
      }
      for (const std::string& each : described(outcome->remarks)) state_.note(each);
      state_.note(joined(describe(quality)));
      state_.ask(OpenPhotographs{.path = job.dataset, .trains = true});
    });
  };
  const auto failed = [this, name = short_name(request.photographs)](const std::string& reason) {
    state_.error("The cameras of " + name + " were not found", reason);
  };
  searcher_.start({.kind = JobKind::cameras,
                   .what = "finding the cameras of " + short_name(request.photographs),
                   .work = work,
                   .failed = failed});
}

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

void Application::measure_training() {
  if (state_.training_seconds || std::exchange(state_.measures_training, true)) return;
  const auto work = [this](const Worker::Progress&) {
    const double seconds = measured_seconds_per_pixel(0);
    return Worker::Completion([this, seconds] {
      state_.measures_training = false;
      state_.training_seconds = seconds;
    });
  };
  // Then there is no forecast.
  const auto failed = [this](const std::string&) { state_.measures_training = false; };
  worker_.start({.kind = JobKind::forecast,
                 .what = "measuring the speed of training",
                 .work = work,
                 .failed = failed});
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
