// A training run with its files, from the checks before the photographs are read to the stored and
// measured scene, for any program that shows its progress.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/json/json_text.hpp"
#include "base/platform/file_lock.hpp"
#include "jobs/eval/evaluation.hpp"
#include "jobs/training/training_method.hpp"
#include "trainer/common/run_control.hpp"
#include "trainer/common/training_files.hpp"

namespace tureen {

struct TrainingJob {
  TrainingOptions training;
  std::filesystem::path output;  // OUT.glb, .ply or .html
  /// Writes the finished scene to `output`; by default write_scene().
  std::function<void(const Scene&)> write = {};
  std::filesystem::path log;            // empty: beside the output
  int threads = 0;                      // 0: one per core
  std::optional<int> checkpoint_every;  // steps; by default every two minutes
  int preview_every = 0;                // steps; 0: no previews
  bool resume = false;                  // from the checkpoint
  std::string input = {};               // RunPlan::input
  std::vector<OwnFact> notes = {};      // further notes for the plan
};

struct TrainingOutcome {
  TrainingSummary training;
  std::optional<Evaluation> evaluation;  // none if the runtime cannot draw the scene here
  std::string why_not_drawn;             // only without an evaluation
  std::vector<std::string> output;       // paths of the written files
};

/// The last line of `tureen train --json`; `views`: number of test views; `scale`: of
/// the photographs.
Json to_json(const TrainingOutcome& outcome, std::size_t views, double scale);

/// What a run reports. All functions are set. Each may throw to end the run.
struct TrainingEvents {
  /// After all checks of the input and before the first step; no file is replaced before.
  std::function<void(const RunPlan&)> begun;
  std::function<void(double fraction)> preparing;  // before the first step
  std::function<void(const trainer::SessionStatus&)> progress;
  /// After the checkpoint of a run that ends early.
  std::function<void(const trainer::SessionStatus&)> interrupted;
  /// The scene before the first step, every few seconds, and when it is finished; may be empty.
  std::function<void(const Scene&)> snapshot;
  /// Writes further files of the finished scene, before the checkpoint is removed; returns their
  /// paths.
  std::function<std::vector<std::string>(const Scene&)> finished;
  std::function<void(double fraction)> measuring;   // by the trainer's own renderer
  std::function<void(double fraction)> evaluating;  // by the runtime
  /// An aid that failed, which does not end the run.
  std::function<void(const std::string&)> failed_aid;
};

/// The files of the run. `job.log`, if given, replaces the default log.
trainer::TrainingFiles files_of(const TrainingJob& job);

class TrainingRun {
 public:
  /// Locks the run's files and checks that they can be written, because training takes hours until
  /// they are; reads the checkpoint. Throws UsageError for wrong options, if another run has the
  /// files, if a file of another kind would be replaced, and for an unfinished run without
  /// `resume`; OutputError; InputError for the checkpoint. `job` must outlive the run.
  explicit TrainingRun(const TrainingJob& job);

  const trainer::TrainingFiles& files() const { return files_; }
  const TrainingMethod& method() const { return *method_; }

  /// Trains to the end, and stores and measures the scene. `start`: the scene of
  /// TrainingOptions::mesh(), or null. Throws the errors of TrainingMethod::settle and train.
  TrainingOutcome train(Dataset& dataset, const Scene* start, const TrainingEvents& events);

 private:
  const TrainingJob& job_;
  std::unique_ptr<TrainingMethod> method_;
  trainer::TrainingFiles files_;
  std::optional<FileLock> lock_, log_lock_;
  std::optional<trainer::RunControl> control_;
};

}  // namespace tureen
