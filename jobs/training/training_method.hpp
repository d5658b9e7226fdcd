// One training run by any method, for a program that offers several: its constants, its checkpoint
// and the run itself. The program reads the dataset and stores the scene. A method is a folder in
// trainer/, a file in this folder, a declaration in methods.hpp and a line in methods.cpp.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jobs/training/run_plan.hpp"
#include "jobs/training/training_options.hpp"
#include "scene/photographs.hpp"
#include "scene/scene.hpp"
#include "trainer/common/checkpoint_file.hpp"
#include "trainer/common/primitive_count.hpp"
#include "trainer/common/whole_run.hpp"

namespace tureen {

struct TrainingSummary {
  trainer::RunResult run;
  trainer::PrimitiveCount primitives;
  int steps = 0;
  std::uint64_t non_finite = 0;  // numbers that were skipped
  std::vector<OwnFact> own = {};
};

/// Why a method cannot begin with a scene, and a hint.
struct UnsuitableStart {
  std::string what, instead;
};

class TrainingMethod {
 public:
  virtual ~TrainingMethod() = default;

  /// Reads the checkpoint to continue from. Throws InputError.
  virtual void resume(const std::filesystem::path& checkpoint) = 0;

  /// Sets the constants: those of the checkpoint, or of the options and the kind of dataset.
  /// `dataset`: null before it is read; the result is then only an early check. Throws UsageError
  /// if the options are invalid, or differ from the checkpoint; InputError for an invalid file.
  virtual void settle(const Dataset* dataset) = 0;

  /// The reason why the first primitives cannot come from this scene; nothing if they can. It is an
  /// early check: train() may still refuse the scene.
  virtual std::optional<UnsuitableStart> unsuitable(const Scene& start) const = 0;

  /// The time of the run; 0: the number of steps is given.
  virtual double minutes() const = 0;

  /// The constants as a --config file.
  virtual std::string constants() const = 0;

  /// After settle() with this dataset. `start`: the scene of TrainingOptions::mesh(), or null.
  /// `begun`: called before the first step, after all checks of the input; no file is replaced
  /// before. Throws UsageError if the checkpoint has other views, and the errors of the method's
  /// run.
  virtual TrainingSummary train(Dataset& dataset, const Scene* start, trainer::RunRequest run,
                                const std::function<void(const RunPlan&)>& begun) = 0;
};

/// A method of training, for programs that offer it.
struct TrainingMethodInfo {
  const char* name;     // as --method takes it
  const char* summary;  // "opaque triangles with textures"
  std::vector<const MethodOption*> options;
  /// Other names, and the flag that each sets; or null.
  std::vector<std::pair<const char*, const MethodOption*>> aliases;
  std::vector<std::string> (*constants)();  // names
  /// All constants as text: name, default, meaning, range or words.
  std::string (*reference)();
  trainer::CheckpointMagic magic;
  // For the size of the photographs by --minutes (photograph_size.hpp): rounded from runs of a
  // minute on a room, a bottle and lego.
  double cost_of_pixel;  // time of a step for each pixel of a photograph, over that of Gaussians
  int least_steps;       // with fewer, smaller photographs give better scenes
  std::unique_ptr<TrainingMethod> (*make)(const TrainingOptions& options);
};

/// All methods; the first one is the default.
std::span<const TrainingMethodInfo* const> training_methods();

/// The method whose checkpoint this file begins as; null if it is none, or cannot be read.
const TrainingMethodInfo* method_of_checkpoint(const std::filesystem::path& file);

/// A run by options.method. Throws UsageError for options of another method, or that exclude each
/// other, and ContextError if the device is missing. `options` must outlive the result.
std::unique_ptr<TrainingMethod> make_training_method(const TrainingOptions& options);

}  // namespace tureen
