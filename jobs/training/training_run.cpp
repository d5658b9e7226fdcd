#include "jobs/training/training_run.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/output.hpp"
#include "formats/scene_file.hpp"
#include "image/png.hpp"
#include "image/video_file.hpp"
#include "jobs/eval/eval_json.hpp"

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

/// A second run with the same output would write into the log and the checkpoint of the first.
/// Throws UsageError if another run holds the lock, OutputError if the file cannot be created.
void take_lock(std::optional<FileLock>& held, const fs::path& file) {
  if (!held.emplace(file).is_held())
    throw UsageError("another run is writing the files beside " + file.string(),
                     "wait for it, stop it, or choose another name with -o");
}

constexpr double max_seconds = 10;
/// Some players do not support lower rates.
constexpr double min_frames_per_second = 5;

Image8 read_frame(const fs::path& file) {
  Input input = Input::open(file);
  return read_image(input);
}

/// Writes the images step_N.png of OUT.previews, in the order of their names, as a video of at most
/// ten seconds, OUT-previews.mp4. Returns its path; nullopt without ffmpeg, or with fewer than two
/// images of one size. Throws InputError and OutputError.
std::optional<fs::path> write_preview_video(const fs::path& previews) {
  if (!have_ffmpeg()) return std::nullopt;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(previews))
    if (entry.path().extension() == ".png" && entry.path().filename().string().starts_with("step_"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.size() < 2) return std::nullopt;
  const Image8 first = read_frame(files.front());
  fs::path path = previews;
  path.replace_extension();
  path += "-previews.mp4";
  VideoFile video(path, {.width = first.width,
                         .height = first.height,
                         .frames_per_second =
                             std::max(min_frames_per_second, double(files.size()) / max_seconds)});
  for (const fs::path& file : files) {
    const Image8 frame = read_frame(file);
    // Images of an earlier run with another size.
    if (frame.width != first.width || frame.height != first.height) return std::nullopt;
    video.add(frame);
  }
  video.commit();
  return path;
}

/// Measures the runtime's images, which users will see: sets `evaluation`, or `why_not_drawn`.
void evaluate(TrainingOutcome& outcome, const Scene& scene, std::span<const Photograph> views,
              const std::function<void(double)>& progress) {
  EvaluationOptions options;
  options.background = scene.info.background;
  options.progress = progress;
  try {
    outcome.evaluation = evaluate(scene, views, options);
  } catch (const ContextError& error) {
    outcome.why_not_drawn = error.reason();
  } catch (const DeviceLimitError& error) {
    outcome.why_not_drawn = error.reason();
  }
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
  take_lock(lock_, files_.lock);
  if (!job.log.empty()) take_lock(log_lock_, fs::path(files_.log) += ".lock");
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
      if (const auto video = write_preview_video(files_.previews))
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

Json to_json(const TrainingOutcome& outcome, std::size_t views, double scale) {
  const TrainingSummary& training = outcome.training;
  Json test{{"views", views}};
  if (views > 0) test.update({{"scale", scale}, {"samples_per_pixel", 1}});
  if (outcome.evaluation) {
    test.update(results::to_json(outcome.evaluation->mean, true));
    test["drawn_by"] = outcome.evaluation->renderer;
  } else if (training.run.test_psnr_db) {
    test["psnr_db"] = *training.run.test_psnr_db;
    test["drawn_by"] = "trainer";
  }
  Json json{{"done", true},
            {"steps", training.steps},
            {"seconds", training.run.seconds},
            {name_of(training.primitives.kind), training.primitives.count}};
  for (const OwnFact& result : training.own)
    std::visit([&](const auto& value) { json[result.name] = value; }, result.value);
  json["test"] = test;
  if (training.run.test_psnr_db) json["trainer_psnr_db"] = *training.run.test_psnr_db;
  json["non_finite"] = training.non_finite;
  json["output"] = outcome.output;
  return json;
}

}  // namespace tureen
