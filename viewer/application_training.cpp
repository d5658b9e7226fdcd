// Starts the training of a scene from the photographs, and reports its end.
#include <algorithm>
#include <string>
#include <vector>

#include "viewer/application.hpp"
#include "viewer/names.hpp"
#include "viewer/render_command.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

std::vector<std::string> Application::training_arguments() const {
  std::error_code ignored;
  const fs::path dataset = fs::absolute(state_.photographs->path, ignored).lexically_normal() / "";
  const fs::path folder = dataset.parent_path();  // without the last slash
  // Beside the photographs, under a name of no scene and no unfinished run.
  const fs::path stem = folder.parent_path() / folder.filename();
  fs::path scene = stem.string() + ".glb";
  const auto taken = [&] {
    return fs::exists(scene, ignored) ||
           fs::exists(fs::path(scene).replace_extension(".checkpoint"), ignored);
  };
  for (int number = 2; taken(); ++number)
    scene = stem.string() + "-" + std::to_string(number) + ".glb";
  return {"train", folder.string(), "-o", scene.string(), "--watch"};
}

void Application::carry_out(const StartTraining&) {
  if (!state_.photographs || training_program_) return;
  const std::vector<std::string> arguments = training_arguments();
  training_program_.emplace(tureen_program(), arguments);
  state_.trained_scene = arguments[3];
  state_.messages.note("The training has started. Another window will show its progress.",
                       state_.now);
}

void Application::carry_out(const CopyTrainingCommand&) {
  if (!state_.photographs) return;
  std::string command = "tureen";
  for (const std::string& argument : training_arguments()) command += " " + quoted(argument);
  window_.set_clipboard(command);
  state_.messages.note("Copied the training command to the clipboard.", state_.now);
}

void Application::watch_training_program() {
  if (!training_program_ || !training_program_->ended()) return;
  const std::string name = short_name(state_.trained_scene);
  if (const auto failure = training_program_->failure())
    state_.messages.error("The training of " + name + " failed", *failure, state_.now);
  else
    state_.messages.note("The training of " + name + " has ended.", state_.now);
  training_program_.reset();
  state_.trained_scene.clear();
  frames_wanted_ = std::max(frames_wanted_, 2);
}

}  // namespace tureen::viewer
