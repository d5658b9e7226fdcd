#include "viewer/training_command.hpp"

#include "viewer/render_command.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

/// Absolute, without the last slash.
fs::path folder_of(const fs::path& dataset) {
  std::error_code ignored;
  return (fs::absolute(dataset, ignored).lexically_normal() / "").parent_path();
}

fs::path checkpoint_of(fs::path scene) { return scene.replace_extension(".checkpoint"); }

}  // namespace

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

}  // namespace tureen::viewer
