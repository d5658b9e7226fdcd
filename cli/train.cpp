// `tureen train`: trains a scene from photographs.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "base/platform/process.hpp"
#include "base/suggestion.hpp"
#include "cli/commands.hpp"
#include "cli/files/photograph_cameras.hpp"
#include "cli/files/scene_page.hpp"
#include "cli/files/window_program.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/arguments.hpp"
#include "cli/options/config_options.hpp"
#include "cli/options/dataset_argument.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "formats/diffsoup/diffsoup_export.hpp"
#include "formats/scene_file.hpp"
#include "jobs/training/diffsoup_options.hpp"
#include "jobs/training/photograph_size.hpp"
#include "jobs/training/run_input.hpp"
#include "jobs/training/training_run.hpp"
#include "trainer/common/kernels/projection.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct TrainOptions {
  DatasetArgument dataset;
  TrainingJob job;
  std::function<bool(const char* option)> is_given = {};
  bool print_config = false;
  bool watch = false;
  bool json = false;
  CameraOptions cameras;               // for photographs without cameras
  std::vector<std::string> arguments;  // of the program
};

/// The folder of --export-diffsoup; empty: none. Throws UsageError if it is another output, or
/// something else that would be replaced.
fs::path checked_export(const TrainOptions& options, const trainer::TrainingFiles& files) {
  fs::path folder = options.job.training[export_option].text;
  if (folder.empty()) return folder;
  if (!folder.has_filename()) folder = folder.parent_path();  // ends in '/'
  for (const fs::path& other :
       {files.scene, files.checkpoint, files.log, files.previews, files.lock, files.watched})
    if (folder.lexically_normal() == other.lexically_normal())
      throw UsageError("--export-diffsoup cannot be " + other.string() +
                       ", which is another output file");
  require_writable_export(folder);
  return folder;
}

void check_images(const TrainOptions& options, const Dataset& dataset) {
  require_sides(options.dataset, dataset,
                {.least = ssim_window, .most = trainer::kernels::max_image_side});
}

void say_result(const TrainOptions& options, const Dataset& dataset,
                const TrainingOutcome& result) {
  const TrainingSummary& training = result.training;
  std::string sentence = fmt::format(
      "{} after {} in {}", counted(training.primitives.count, noun_of(training.primitives.kind)),
      counted(std::uint64_t(training.steps), "step"), duration_text(training.run.seconds));
  for (const OwnFact& own : training.own)
    if (!own.text.empty()) sentence += "; " + own.text;
  say(sentence);
  if (training.non_finite > 0) say("skipped " + counted(training.non_finite, "non-finite number"));
  if (training.run.test_psnr_db) {
    const Camera& first = dataset.test.front().camera;
    say(fmt::format("{} of {} x {} (--scale {:g}), one sample per pixel:",
                    counted(dataset.test.size(), "test view"), first.width, first.height,
                    options.dataset.options.scale));
    Table table({"", "PSNR dB", "SSIM", "FLIP"});
    table.row({"drawn by the trainer", fmt::format("{:.2f}", *training.run.test_psnr_db)});
    if (result.evaluation) {
      const ViewMetrics& mean = result.evaluation->mean;
      table.row({options.job.output.string(), fmt::format("{:.2f}", mean.psnr_db),
                 fmt::format("{:.4f}", mean.ssim), fmt::format("{:.4f}", mean.flip)});
    }
    for (const std::string& line : table.lines()) say(line);
  }
  for (const std::string& path : result.output) say("wrote " + path);
}

/// The window of --watch. It is an aid: its failures do not end the run.
class TrainingWindow {
 public:
  TrainingWindow(const TrainOptions& options, const trainer::TrainingFiles& files)
      : options_(options), files_(files) {}

  /// Writes the scene for the window, which the first call starts.
  void show(const Scene& scene) {
    if (failed_) return;
    try {
      write_scene(scene, files_.watched);
      if (!std::exchange(started_, true))
        start_window({fs::absolute(files_.watched).string(),
                      fs::absolute(options_.dataset.path).string(), "--training",
                      fs::absolute(files_.log).string()});
    } catch (const Error& error) {
      failed_ = true;
      say(std::string("The window failed; training continues: ") + error.what());
    }
  }

 private:
  const TrainOptions& options_;
  const trainer::TrainingFiles& files_;
  bool started_ = false, failed_ = false;
};

/// The scene of --init.
std::optional<Scene> read_start(const TrainingOptions& options, const TrainingMethod& method) {
  const fs::path path = options.mesh();
  if (path.empty()) return std::nullopt;
  const std::vector<std::string> words{"random", "points"};
  if (is_missing(path))
    throw InputError({path.string(), {}, {}},
                     why_missing(path) + "; --init takes random, points or a scene",
                     did_you_mean(path.string(), words));
  Scene scene = read_one_layer(SceneArgument{.path = path.string()});
  if (const auto reason = method.unsuitable(scene))
    throw InputError({path.string(), {}, {}}, reason->what, reason->instead);
  return scene;
}

/// Notes for after all checks of the inputs, immediately before the training replaces files.
std::vector<std::string> first_notes(const TrainingJob& job, const Dataset& dataset) {
  std::vector<std::string> notes;
  std::error_code error;
  if (!job.resume && fs::exists(job.output, error))
    notes.push_back(job.output.string() +
                    " exists; training replaces its log now and the file at the end");
  if (dataset.test.empty())
    notes.push_back("The dataset has no test views: the training does not measure its error");
  return notes;
}

/// Reads the inputs of a run. Ctrl-C during reading writes no checkpoint, unlike Ctrl-C during
/// training, so this prints a message.
template <class Work>
auto before_the_first_step(const TrainOptions& options, Work&& read) {
  try {
    return read();
  } catch (const Interrupted&) {
    if (!options.print_config)
      say(options.job.resume ? "interrupted before a step was complete; the checkpoint is unchanged"
                             : "interrupted before a step was complete; no checkpoint was written");
    throw;
  }
}

/// With --resume: the method of the checkpoint, and dataset options that are not given come from
/// the log. Throws UsageError if the dataset is unknown.
void take_from_the_run(TrainOptions& options) {
  TrainingJob& job = options.job;
  if (job.resume && !job.output.empty()) {
    const trainer::TrainingFiles files = files_of(job);
    if (!options.is_given("--method"))
      if (const auto* method = method_of_checkpoint(files.checkpoint)) job.training.method = method;
    if (std::optional<RunInput> input = input_of_log(files.log)) {
      DatasetOptions& now = options.dataset.options;
      if (options.dataset.path.empty()) options.dataset.path = input->dataset;
      if (options.is_given("--scale")) input->options.scale = now.scale;
      if (options.is_given("--images")) input->options.images_folder = now.images_folder;
      if (options.is_given("--test-every")) input->options.test_every = now.test_every;
      if (options.is_given("--alpha")) input->options.alpha = now.alpha;
      input->options.is_strict |= now.is_strict;
      now = input->options;
    }
  }
  if (options.dataset.path.empty())
    throw UsageError("DATASET is required",
                     "pass it; --resume reads it from the log beside OUT, if that exists");
}

/// With --minutes: chooses the size of the photographs, unless --scale does, and notes if the time
/// is too short for them. Returns the photographs, to compare with the steps at the end.
std::optional<FullPhotographs> choose_size(TrainOptions& options, const TrainingMethod& method) {
  TrainingJob& job = options.job;
  if (method.minutes() == 0 || job.resume) return {};
  FullPhotographs full = full_photographs(options.dataset.path, options.dataset.options);
  const TrainingMethodInfo& info = *job.training.method;
  const double speed = measured_seconds_per_pixel(job.threads);
  double& scale = options.dataset.options.scale;
  if (!options.is_given("--scale")) {
    const PhotographSize size = photographs_for(method.minutes(), full, info, speed);
    scale = size.scale;
    job.notes.push_back(size.note);
  }
  const auto forecast = forecast_of({.minutes = method.minutes()}, scale, full, info, speed);
  if (auto warning = too_few_steps(forecast->steps, full, info)) job.notes.push_back(*warning);
  return full;
}

Dataset read_dataset(const TrainOptions& options) {
  Dataset dataset =
      before_the_first_step(options, [&] { return read(options.dataset, DatasetPart::all); });
  check_images(options, dataset);
  return dataset;
}

ExitCode print_config(const TrainOptions& options) {
  const TrainingJob& job = options.job;
  const std::unique_ptr<TrainingMethod> method = make_training_method(job.training);
  if (job.resume) method->resume(trainer::training_files(job.output).checkpoint);
  method->settle(nullptr);
  const Dataset dataset = read_dataset(options);
  method->settle(&dataset);
  print_text(method->constants());
  return ExitCode::done;
}

/// Photographs without cameras are trained as Gaussians, for 15 minutes, unless options choose
/// otherwise. Training begins again if Ctrl-C ended the search for their cameras.
void set_presets(TrainOptions& options) {
  TrainingJob& job = options.job;
  TrainingOptions& training = job.training;
  if (!options.is_given("--method") && training.file.empty())
    for (const TrainingMethodInfo* method : training_methods())
      if (method->name == std::string_view("gaussians")) training.method = method;
  OptionValue& minutes = training.own["minutes"];
  const auto& own = training.method->options;
  const bool has_minutes = std::any_of(own.begin(), own.end(), [](const MethodOption* option) {
    return option->name == std::string_view("minutes");
  });
  if (has_minutes && !minutes.is_given() && !training.steps && training.file.empty())
    minutes.number = 15;
  std::error_code ignored;
  if (!fs::exists(files_of(job).checkpoint, ignored)) job.resume = false;
}

/// Throws InputError for a folder of photographs in a dataset: their cameras are there.
void require_no_dataset_around(const std::string& photographs) {
  if (const auto dataset = dataset_around(photographs))
    throw InputError({photographs}, "the folder around these photographs is a dataset with cameras",
                     "tureen train " + shell_word(dataset->string()) +
                         " trains from it; tureen cameras " + shell_word(photographs) +
                         " finds cameras for these photographs");
}

/// Finds the cameras, unless an earlier run has, and makes the dataset that of the run. Prints the
/// commands for which this one stands.
void use_photographs(TrainOptions& options) {
  CameraOptions& cameras = options.cameras;
  cameras.photographs = options.dataset.path;
  cameras.dataset = fs::path(options.job.output).replace_extension(".dataset");
  cameras.threads = options.job.threads;
  if (has_cameras(cameras))
    say(cameras.dataset.string() + " has the cameras of these photographs");
  else
    search_cameras(cameras);
  options.dataset.path = cameras.dataset.string();
  std::string command = "tureen";
  for (const std::string& word : options.arguments)
    command += " " + shell_word(word == cameras.photographs ? options.dataset.path : word);
  if (!options.is_given("--method") && options.job.training.file.empty())
    command += " --method gaussians";
  if (!options.is_given("--scale")) {
    options.dataset.options.scale = scale_for_training(cameras.dataset);
    if (options.dataset.options.scale < 1)
      command += fmt::format(" --scale {:g}", options.dataset.options.scale);
  }
  if (const auto& minutes = options.job.training.own["minutes"].number;
      minutes && command.find("--minutes") == std::string::npos)
    command += fmt::format(" --minutes {:g}", *minutes);
  say("These commands do the same:");
  say("  tureen cameras " + shell_word(cameras.photographs.string()) + " -o " +
      shell_word(options.dataset.path));
  say("  " + command);
}

ExitCode train(TrainOptions options) {
  take_from_the_run(options);
  if (options.print_config) return print_config(options);
  const bool finds_cameras = is_photographs(options.dataset.path);
  if (finds_cameras) require_no_dataset_around(options.dataset.path);
  if (finds_cameras && !options.job.output.empty()) set_presets(options);
  outlive_readers();  // a closed pipe must not end hours of training
  const TrainingJob& job = options.job;
  if (job.output.empty()) throw UsageError("-o OUT.glb is required");
  // Wrong arguments are reported before the photographs are read.
  std::optional<ScenePageTemplate> page;
  if (is_scene_page(job.output)) page = ScenePageTemplate::find();
  options.job.write = [&](const Scene& scene) {
    say_list("Lost in " + job.output.string() + ":",
             page ? write_page(*page, scene, job.output) : write_scene(scene, job.output));
  };
  const fs::path diffsoup_export = checked_export(options, files_of(job));
  TrainingRun run(job);
  const trainer::TrainingFiles& files = run.files();
  if (finds_cameras) use_photographs(options);
  const std::optional<Scene> start = before_the_first_step(
      options, [&] { return job.resume ? std::nullopt : read_start(job.training, run.method()); });
  std::optional<FullPhotographs> full;
  if (!finds_cameras) full = choose_size(options, run.method());
  Dataset dataset = read_dataset(options);
  options.job.input = to_json(RunInput{options.dataset.path, options.dataset.options}, files.log);

  Progress::Output output = Progress::standard_error();
  output.line_seconds = 10;
  std::optional<Progress> progress;
  const auto show = [&](const char* what, double fraction) {
    if (!progress) progress.emplace(what, output);
    progress->update(fraction);
  };
  TrainingWindow window(options, files);
  const std::vector<std::string> notes = first_notes(job, dataset);
  TrainingEvents events;
  events.begun = [&](const RunPlan& plan) {
    progress.reset();
    for (const std::string& note : notes) say(note);
    for (const std::string& line : describe(plan)) say(line);
  };
  events.preparing = [&](double fraction) {
    before_the_first_step(options, [&] {
      try {
        show("preparing the first step", fraction);
      } catch (const Interrupted&) {
        progress.reset();
        throw;
      }
    });
  };
  events.progress = [&](const trainer::SessionStatus& now) {
    if (!progress) progress.emplace("training", output);
    progress->update(now.fraction, describe(now));
  };
  events.interrupted = [&](const trainer::SessionStatus& now) {
    progress.reset();
    say(fmt::format("wrote {} after step {} of {}; tureen train -o {} --resume continues from it",
                    files.checkpoint.string(), counted(std::uint64_t(now.step)),
                    counted(std::uint64_t(now.steps)), job.output.string()));
  };
  if (options.watch) events.snapshot = [&](const Scene& scene) { window.show(scene); };
  bool is_stored = false;
  events.finished = [&](const Scene& scene) -> std::vector<std::string> {
    is_stored = true;
    progress.reset();
    if (diffsoup_export.empty()) return {};
    say_list("Lost in " + diffsoup_export.string() + ":",
             write_diffsoup_export(scene, diffsoup_export));
    return {diffsoup_export.string()};
  };
  events.measuring = [&](double fraction) { show("measuring", fraction); };
  std::optional<Progress> evaluating;
  events.evaluating = [&](double fraction) {
    progress.reset();
    if (!evaluating) evaluating.emplace("evaluating");
    evaluating->update(fraction);
  };
  events.failed_aid = [](const std::string& sentence) { say(sentence); };

  say_list("Reading " + options.dataset.path + ":", notes_of(dataset.remarks));
  TrainingOutcome result;
  try {
    result = run.train(dataset, start ? &*start : nullptr, events);
  } catch (const Interrupted&) {
    if (is_stored)
      say("wrote " + files.scene.string() +
          "; interrupted before it was measured on the test views");
    throw;
  }
  // A run uses at least 95 % of its minutes, unless its user ended it by *Stop and keep*.
  if (full && result.training.run.seconds >= 0.9 * 60 * run.method().minutes())
    if (auto warning = too_few_steps(result.training.steps, *full, *job.training.method))
      result.training.own.push_back(*warning);
  progress.reset();
  evaluating.reset();
  if (!result.evaluation && !dataset.test.empty())
    say("The runtime cannot draw the scene here; the metrics are from the trainer's own "
        "renderer: " +
        result.why_not_drawn);
  say_result(options, dataset, result);
  if (options.json)
    print_json_line(to_json(result, dataset.test.size(), options.dataset.options.scale));
  return ExitCode::done;
}

void add_file_options(Command& command, TrainOptions& options) {
  TrainingJob& job = options.job;
  command.add_option(
      "-o,--output OUT.glb", [&job](const std::string& path) { job.output = path; },
      "scene to write: .glb, .ply or .html, a page");
  command.add_option(
      "--log FILE", [&job](const std::string& path) { job.log = path; },
      "training log to write, JSON lines; OUT.jsonl by default (tureen report plots it)");
  command.add_option("--checkpoint-every N", job.checkpoint_every,
                     "steps between checkpoints in OUT.checkpoint; every two minutes by default",
                     between(1, 10'000'000));
  command.add_flag(
      "--resume", job.resume,
      "continue from OUT.checkpoint; gives the same result as an uninterrupted run; needs only -o");
  command.add_option(
      "--preview-every N", job.preview_every,
      "steps between previews, images in the folder OUT.previews of a test view beside its "
      "photograph; no previews by default; with ffmpeg also a video, OUT-previews.mp4",
      between(1, 10'000'000));
  command.add_flag(
      "--watch", options.watch,
      "open a window with the scene and loss curves, to pause, stop or finish the run; its "
      "scene is OUT.watch.glb");
}

}  // namespace

void add_train(Command& program, std::vector<std::string> arguments) {
  auto options = std::make_shared<TrainOptions>();
  options->arguments = std::move(arguments);
  Command command = program.add_command("train", "Train a scene from photographs");
  command.footer(
      R"(Trains a scene to match the photographs: triangles with lattice textures and a color MLP
(--method diffsoup), Gaussians or, with --flat, discs (--method gaussians), triangles (soft, or opaque
with --opaque) with one view-dependent colour each (--method triangles), or ellipsoids with a small
network each (--method neural). Writes the scene as OUT.glb and a log as OUT.jsonl, and measures the
scene on the test views. Ctrl-C writes a checkpoint; --resume continues from it. Equal seeds give
equal scenes on a CPU, with any number of threads. For all methods but diffsoup, --max-memory also
limits the number of splats.

DATASET may also be a folder of photographs without cameras, or a video: COLMAP first finds the
cameras, as tureen cameras does. By default, Gaussians are then trained for 15 minutes, from
photographs of at most 1,000 pixels per side.

Examples:
  tureen train photos -o scene.glb                           photographs, or a video: walk.mp4
  tureen train lego -o lego.glb
  tureen train fox -o fox.glb --scale 0.25 --steps 5000      fast, with smaller photographs
  tureen train -o fox.glb --resume                           after Ctrl-C
  tureen train lego -o lego.glb --minutes 5                  as many steps as fit in 5 minutes
  tureen train lego -o lego.ply --method gaussians           a file for other viewers
  tureen train lego -o lego.glb --method triangles --opaque   a soup, one colour per triangle
  tureen train lego -o lego.glb --method neural --max-bytes 100000   a very small scene
  tureen train lego -o lego.glb --preview-every 500          writes previews
  tureen train lego -o lego.glb --watch                      shows the training in a window
  tureen train lego -o better.glb --init lego.glb            continues from a trained soup
  tureen train lego --print-config > lego.json               all constants, for --config

Exit codes: 0 done, 2 wrong usage, or --resume with another dataset or other constants,
3 the photographs, the checkpoint or the configuration cannot be read, or there are no cameras,
4 no GPU for --device cuda, 5 interrupted, or the scene cannot be written.)");
  add_dataset_argument(command, options->dataset).required(false);
  options->is_given = [command](const char* option) { return command.option(option).is_given(); };
  add_memory_option(command,
                    [options](std::uint64_t bytes) { options->job.training.max_memory = bytes; });
  add_file_options(command, *options);
  add_config_options(command, options->job.training);
  add_camera_options(command, options->cameras);
  command.add_option("--threads N", options->job.threads,
                     "number of CPU threads; one per core by default", between(1, 1024));
  command.add_flag("--print-config", options->print_config,
                   "print all constants of this run as JSON, without training");
  command.add_text_flag(
      "--list-config", [options] { return options->job.training.method->reference(); },
      "list all constants of the method with their defaults, ranges and meanings, and exit");
  command.add_flag("--json", options->json,
                   "print the result as one line of JSON to standard output");
  command.does([options] { return train(*options); });
}

}  // namespace tureen::cli
