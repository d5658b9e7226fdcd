#include "jobs/training/training_run.hpp"

#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/output.hpp"
#include "formats/scene_file.hpp"
#include "trainer/common/preview_video.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;
using trainer::SessionStatus;
using trainer::TrainingFiles;

/// Throws UsageError if the log is another file of the run, or a file of another kind: the user may
/// not have named it, and training would replace it.
void check_log(const TrainingFiles& files) {
  for (const fs::path& other : {files.scene, files.checkpoint, files.previews, files.lock,
                                files.watched, trainer::control_file(files.log)})
    if (files.log.lexically_normal() == other.lexically_normal())
      throw UsageError("--log cannot be " + other.string() + ", which is another output file");
  std::error_code error;
  if (!fs::exists(files.log, error)) return;
  // Every line of a log begins like this. A truncated line passes, too.
  constexpr std::string_view beginning = "{\"step\":";
  Input input = Input::open(files.log);
  std::string found(beginning.size(), '\0');
  found.resize(input.read_some(std::as_writable_bytes(std::span(found))));
  if (found != beginning.substr(0, found.size()))
    throw UsageError(files.log.string() + " exists and is not a training log",
                     "choose another name");
}

/// Creates and removes a temporary file beside each file.
void check_writable(const TrainingFiles& files) {
  for (const fs::path& file : {files.scene, files.checkpoint, files.log}) const Output probe(file);
  check_log(files);
}

/// Throws UsageError if the run would replace an existing file by mistake.
void check_existing(const TrainingJob& job, const TrainingFiles& files) {
  std::error_code error;
  if (const fs::path mesh = job.training.mesh(); fs::equivalent(mesh, files.scene, error))
    throw UsageError("-o would replace " + mesh.string() + ", the scene for --init",
                     "choose another name");
  const bool has_checkpoint = fs::exists(files.checkpoint, error);
  if (job.resume && !has_checkpoint)
    throw InputError({files.checkpoint.string(), {}, {}},
                     "there is no such file: the training has ended, or was not begun",
                     "leave --resume out to train");
  if (!job.resume && has_checkpoint)
    throw UsageError(files.checkpoint.string() + " exists, from an unfinished run",
                     "continue this run with --resume, or remove the file to start again");
}

}  // namespace

TrainingFiles files_of(const TrainingJob& job) {
  TrainingFiles files = trainer::training_files(job.output);
  if (!job.log.empty()) files.log = job.log;
  return files;
}

TrainingRun::TrainingRun(const TrainingJob& job)
    : job_(job), method_(make_training_method(job.training)), files_(files_of(job)) {
  check_writable(files_);
  lock_.emplace(files_.lock);
  if (!job.log.empty()) log_lock_.emplace(fs::path(files_.log) += ".lock");
  check_existing(job, files_);
  control_.emplace(trainer::control_file(files_.log));
  if (job.preview_every > 0) make_folder(files_.previews);
  if (job.resume) method_->resume(files_.checkpoint);
  method_->settle(nullptr);
}

TrainingOutcome TrainingRun::train(Dataset& dataset, const Scene* start,
                                   const TrainingEvents& events) {
  method_->settle(&dataset);
  TrainingOutcome result;
  const auto store = [&](const Scene& scene) {
    if (job_.write)
      job_.write(scene);
    else
      write_scene(scene, files_.scene);
    result.output.push_back(files_.scene.string());
    for (std::string& path : events.finished(scene)) result.output.push_back(std::move(path));
    std::error_code ignored;
    fs::remove(files_.checkpoint, ignored);
    result.output.push_back(files_.log.string());
    if (job_.preview_every == 0) return;
    try {
      if (const auto video = trainer::write_preview_video(files_.previews))
        result.output.push_back(video->string());
    } catch (const Error& error) {
      events.failed_aid(std::string("Could not make a video of the previews: ") + error.what());
    }
  };
  trainer::RunRequest run;
  run.name = files_.scene.stem().string();
  run.threads = job_.threads;
  run.session.checkpoint = files_.checkpoint;
  run.session.log = files_.log;
  run.session.previews = files_.previews;
  run.session.checkpoint_every = job_.checkpoint_every;
  run.session.preview_every = job_.preview_every;
  run.session.control = &*control_;
  run.session.progress = events.progress;
  run.session.interrupted = events.interrupted;
  run.preparing = events.preparing;
  run.snapshot = events.snapshot;
  run.finished = store;
  run.measuring = events.measuring;
  run.evaluate = [&](const Scene& scene) {
    evaluate(result, scene, dataset.test, events.evaluating);
  };
  std::string plan_json;
  run.session.plan = [&] { return plan_json; };
  result.training = method_->train(dataset, start, std::move(run), [&](const RunPlan& settled) {
    RunPlan plan = settled;
    plan.method = job_.training.method->name;
    plan.constants = method_->constants();
    plan.input = job_.input;
    plan.notes.insert(plan.notes.begin(), job_.notes.begin(), job_.notes.end());
    plan_json = to_json(plan).dump();
    events.begun(plan);
  });
  return result;
}

}  // namespace tureen
