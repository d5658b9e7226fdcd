#include "viewer/training_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/decimal_text.hpp"
#include "base/extension.hpp"
#include "trainer/common/training_files.hpp"
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

fs::path checkpoint_of(const fs::path& scene) { return trainer::training_files(scene).checkpoint; }

fs::path new_trained_scene(const fs::path& dataset) {
  std::error_code ignored;
  const std::string stem = folder_of(dataset).string();
  fs::path scene = stem + ".glb";
  for (int number = 2; fs::exists(scene, ignored) || fs::exists(checkpoint_of(scene), ignored);
       ++number)
    scene = stem + "-" + std::to_string(number) + ".glb";
  return scene;
}

TypedScene check_typed_scene(const fs::path& scene) {
  std::error_code error;
  if (scene.empty()) return {.remark = "", .is_possible = false};
  if (fs::is_directory(scene, error))
    return {.remark = "This is a folder: type the name of a file.", .is_possible = false};
  const fs::path folder = fs::absolute(scene, error).parent_path();
  if (!fs::is_directory(folder, error))
    return {.remark = "There is no folder " + folder.string() + ".", .is_possible = false};
  if (extension_of(scene) != ".glb")
    return {.remark = "The name must end in .glb.", .is_possible = false};
  if (fs::exists(checkpoint_of(scene), error))
    return {.remark = "There is an unfinished training of this file, which can continue.",
            .is_unfinished = true};
  return {.remark = fs::exists(scene, error) ? "This file exists. The training replaces it." : ""};
}

std::string dataset_defect(const fs::path& dataset) {
  std::error_code error;
  if (!fs::exists(dataset, error)) return "";
  if (!fs::is_directory(dataset, error)) return "This is a file: type the name of a new folder.";
  if (fs::is_empty(dataset, error)) return "";
  return "This folder exists and is not empty: type another name.";
}

std::vector<std::string> training_arguments(const fs::path& dataset, const fs::path& scene,
                                            TrainingStart start, const TrainingChoice& choice) {
  std::vector<std::string> arguments{"train", folder_of(dataset).string(), "-o", scene.string(),
                                     "--watch"};
  const auto add = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {"--" + option, value});
  };
  const bool resumes = start == TrainingStart::from_checkpoint;
  const TrainingMethodInfo* method =
      resumes ? method_of_checkpoint(checkpoint_of(scene)) : choice.method;
  if (method && method != training_methods().front()) add("method", method->name);
  if (resumes) {
    arguments.emplace_back("--resume");
    return arguments;
  }
  add("steps", choice.steps);
  add("scale", choice.scale);
  for (const MethodOption* option : method->options) {
    const auto typed = choice.values.find(option->name);
    if (typed == choice.values.end() || typed->second.empty()) continue;
    if (option->type == MethodOption::Type::flag)
      arguments.push_back(std::string("--") + option->name);
    else
      add(option->name, typed->second);
  }
  return arguments;
}

std::string forecast_text(const TrainingChoice& choice, const FullPhotographs& full,
                          double seconds_per_pixel) {
  // What is no number counts as 0; `tureen train` reports it.
  const auto number = [](const std::string& text) { return std::strtod(text.c_str(), nullptr); };
  const auto minutes = choice.values.find("minutes");
  const double typed_minutes = minutes == choice.values.end() ? 0 : number(minutes->second);
  const auto forecast =
      forecast_of({.minutes = typed_minutes, .steps = number(choice.steps)},
                  choice.scale.empty() ? std::nullopt : std::optional(number(choice.scale)), full,
                  *choice.method, seconds_per_pixel);
  if (!forecast) return "Enter a time for a forecast. Default: the method's own number of steps.";
  const Camera& first = full.cameras.front();
  const std::string size =
      fmt::format("photographs of {:.0f} \u00d7 {:.0f}", std::round(first.width * forecast->scale),
                  std::round(first.height * forecast->scale));
  if (typed_minutes > 0) {
    const auto warning = too_few_steps(forecast->steps, full, *choice.method);
    return "About " + counted(std::uint64_t(std::max(one_digit(forecast->steps), 1.0))) +
           " steps on " + size + (warning ? "; " + warning->text : "") + ".";
  }
  return "About " + duration_text(60 * one_digit(forecast->minutes)) + " on " + size + ".";
}

std::string command_that_continues(const fs::path& dataset, const fs::path& scene) {
  std::error_code ignored;
  if (!fs::exists(checkpoint_of(scene), ignored)) return "";
  return quoted_command(training_arguments(dataset, scene, TrainingStart::from_checkpoint));
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
