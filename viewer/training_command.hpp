// The command that trains a scene from photographs.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/training/photograph_size.hpp"
#include "jobs/training/training_method.hpp"

namespace tureen::viewer {

/// Time of the last change; nullopt: there is no such file.
using FileTime = std::optional<std::filesystem::file_time_type>;
FileTime time_of(const std::filesystem::path& file);

/// OUT.checkpoint of OUT.glb.
std::filesystem::path checkpoint_of(const std::filesystem::path& scene);

/// A path beside the dataset, absolute, that no scene and no unfinished run has: fox.glb,
/// fox-2.glb.
std::filesystem::path new_trained_scene(const std::filesystem::path& dataset);

/// The file that the user has typed for the scene of a training.
struct TypedScene {
  std::string remark;          // to show; empty: none
  bool is_possible = true;     // otherwise the training would be refused
  bool is_unfinished = false;  // there is a checkpoint: a training can only continue from it
};
TypedScene check_typed_scene(const std::filesystem::path& scene);

/// Why the cameras of photographs cannot be written to this folder, as typed; empty: they can.
std::string dataset_defect(const std::filesystem::path& dataset);

enum class TrainingStart { new_run, from_checkpoint };

/// A method with its options as typed; an empty text is the default. `tureen train` checks them.
struct TrainingChoice {
  const TrainingMethodInfo* method = training_methods().front();
  std::string steps = {};
  std::string scale = {};                          // of the photographs, as --scale takes it
  bool scale_is_preset = false;                    // moderate_scale(), not chosen by the user
  std::map<std::string, std::string> values = {};  // by MethodOption::name; of a flag, any text
};

/// "About 2,000 steps on photographs of 540 x 360": for a window. Without minutes and steps, that
/// their number is the method's own. `full`: the photographs of the dataset.
std::string forecast_text(const TrainingChoice& choice, const FullPhotographs& full,
                          double seconds_per_pixel);

/// The arguments of `tureen` that train `scene` from the dataset, with a window that shows it. A
/// run from a checkpoint keeps its method and constants and ignores `choice`.
std::vector<std::string> training_arguments(const std::filesystem::path& dataset,
                                            const std::filesystem::path& scene,
                                            TrainingStart start = TrainingStart::new_run,
                                            const TrainingChoice& choice = {});

/// The command that continues this training from its checkpoint; empty if there is none.
std::string command_that_continues(const std::filesystem::path& dataset,
                                   const std::filesystem::path& scene);

/// A training that has ended.
struct EndedTraining {
  std::filesystem::path dataset, scene;
  bool is_stopped = false;                  // the window has interrupted it
  bool wrote_scene = false;                 // since its start
  bool wrote_checkpoint = false;            // since it was stopped
  std::optional<std::string> failure = {};  // BackgroundProgram::failure()
};
/// The window's note about its end: complete, or stopped with a checkpoint or the reason why there
/// is none. Empty if it failed.
std::string note_of(const EndedTraining& training);

}  // namespace tureen::viewer
