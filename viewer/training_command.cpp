#include "viewer/training_command.hpp"

#include "viewer/names.hpp"
#include "viewer/render_command.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

/// Absolute, without the last slash.
fs::path folder_of(const fs::path& dataset) {
  std::error_code ignored;
  return (fs::absolute(dataset, ignored).lexically_normal() / "").parent_path();
}

}  // namespace

FileTime time_of(const fs::path& file) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(file, error);
  return error ? FileTime{} : time;
}

fs::path checkpoint_of(const fs::path& scene) {
  return fs::path(scene).replace_extension(".checkpoint");
}

fs::path new_trained_scene(const fs::path& dataset) {
  std::error_code ignored;
  const std::string stem = folder_of(dataset).string();
  fs::path scene = stem + ".glb";
  for (int number = 2; fs::exists(scene, ignored) || fs::exists(checkpoint_of(scene), ignored);
       ++number)
    scene = stem + "-" + std::to_string(number) + ".glb";
  return scene;
}

std::vector<std::string> training_arguments(const fs::path& dataset, const fs::path& scene) {
  return {"train", folder_of(dataset).string(), "-o", scene.string(), "--watch"};
}

std::string command_that_continues(const fs::path& dataset, const fs::path& scene) {
  std::error_code ignored;
  if (!fs::exists(checkpoint_of(scene), ignored)) return "";
  return quoted_command(training_arguments(dataset, scene)) + " --resume";
}

std::string note_of(const EndedTraining& training) {
  const std::string name = "The training of " + short_name(training.scene);
  const std::string further = command_that_continues(training.dataset, training.scene);
  // Also if it was stopped while it measured the complete scene.
  if (!training.failure || (training.wrote_scene && further.empty())) return name + " has ended.";
  if (!training.is_stopped) return "";
  const std::string reason = training.wrote_checkpoint ? "." : ": " + *training.failure + ".";
  return name + " was stopped" + reason +
         (further.empty() ? " It has no checkpoint." : " To continue: " + further);
}

}  // namespace tureen::viewer
