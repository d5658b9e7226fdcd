// `tureen train`: trains a scene from photographs.
#include <fmt/format.h>

#include <functional>
#include <memory>
#include <utility>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "base/suggestion.hpp"
#include "cli/commands.hpp"
#include "cli/files/train_files.hpp"
#include "cli/files/window_program.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/arguments.hpp"
#include "cli/options/config_options.hpp"
#include "cli/options/dataset_argument.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "formats/diffsoup/diffsoup_export.hpp"
#include "formats/scene_file.hpp"
#include "jobs/training/training_method.hpp"
#include "jobs/training/training_outcome.hpp"
#include "trainer/common/kernels/projection.hpp"
#include "trainer/common/preview_video.hpp"
#include "trainer/common/run_control.hpp"
#include "trainer/common/run_lock.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct TrainOptions {
  DatasetArgument dataset;
  TrainingOptions training;
  std::string output;
  std::string log;              // empty: beside the output
  std::string diffsoup_export;  // empty: none
  int threads = 0;
  std::optional<int> checkpoint_every;
  int preview_every = 0;
  bool resume = false;
  bool print_config = false;
  bool watch = false;
  bool json = false;
};

TrainingFiles files_of(const TrainOptions& options) {
  if (options.output.empty()) throw UsageError("-o OUT.glb is required");
  if (!options.diffsoup_export.empty() && options.training.method != TrainingMethodName::diffsoup)
    throw UsageError("--export-diffsoup needs --method diffsoup",
                     "Tureen's own page shows scenes of every method: tureen convert OUT.glb "
                     "page.html");
  TrainingFiles files = training_files(options.output);
  if (!options.log.empty()) files.log = options.log;
  fs::path folder = options.diffsoup_export;
  if (!folder.empty() && !folder.has_filename()) folder = folder.parent_path();  // ends in '/'
  files.diffsoup_export = folder;
  return files;
}

void check_images(const TrainOptions& options, const Dataset& dataset) {
  require_sides(options.dataset, dataset,
                {.least = ssim_window, .most = trainer::kernels::max_image_side});
}

/// Writes the previews as a video. It is an aid: its failures do not end the run.
void write_video(const TrainingFiles& files, TrainingOutcome& result) {
  try {
    if (const auto video = trainer::write_preview_video(files.previews))
      result.output.push_back(video->string());
  } catch (const Error& error) {
    say(std::string("The previews did not become a video: ") + error.what());
  }
}

/// Writes the scene and the DiffSoup export, then removes the checkpoint.
void write_results(const TrainOptions& options, const TrainingFiles& files, const Scene& scene,
                   TrainingOutcome& result) {
  write_scene(scene, files.scene);
  result.output.push_back(files.scene.string());
  if (!files.diffsoup_export.empty()) {
    say_list("Lost in " + files.diffsoup_export.string() + ":",
             write_diffsoup_export(scene, files.diffsoup_export));
    result.output.push_back(files.diffsoup_export.string());
  }
  std::error_code ignored;
  fs::remove(files.checkpoint, ignored);
  result.output.push_back(files.log.string());
  if (options.preview_every > 0) write_video(files, result);
}

void say_result(const TrainOptions& options, const Dataset& dataset,
                const TrainingOutcome& result) {
  const TrainingSummary& training = result.training;
  std::string sentence = fmt::format(
      "{} after {} in {}", counted(training.primitives.count, noun_of(training.primitives.kind)),
      counted(std::uint64_t(training.steps), "step"), duration_text(training.run.seconds));
  if (training.opacity_binary_fraction)
    sentence += fmt::format("; {:.1f} % of the texels are transparent or opaque",
                            100 * *training.opacity_binary_fraction);
  say(sentence);
  if (training.non_finite > 0) say("skipped " + counted(training.non_finite, "non-finite number"));
  if (training.run.test_psnr_db) {
    Table table({counted(dataset.test.size(), "test view"), "PSNR dB", "SSIM", "FLIP"});
    table.row({"drawn by the trainer", fmt::format("{:.2f}", *training.run.test_psnr_db)});
    if (result.evaluation) {
      const ViewMetrics& mean = result.evaluation->mean;
      table.row({options.output, fmt::format("{:.2f}", mean.psnr_db),
                 fmt::format("{:.4f}", mean.ssim), fmt::format("{:.4f}", mean.flip)});
    }
    for (const std::string& line : table.lines()) say(line);
  }
  for (const std::string& path : result.output) say("wrote " + path);
}

/// The window of --watch. It is an aid: its failures do not end the run.
class TrainingWindow {
 public:
  TrainingWindow(const TrainOptions& options, const TrainingFiles& files)
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
      say(std::string("The training goes on without its window: ") + error.what());
    }
  }

 private:
  const TrainOptions& options_;
  const TrainingFiles& files_;
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

/// Throws UsageError if the run would replace an existing file by mistake.
void check_existing(const TrainOptions& options, const TrainingFiles& files) {
  std::error_code error;
  if (const fs::path mesh = options.training.mesh(); fs::equivalent(mesh, files.scene, error))
    throw UsageError("-o would replace " + mesh.string() + ", the scene for --init",
                     "choose another name");
  if (!options.resume && fs::exists(files.checkpoint, error))
    throw UsageError(files.checkpoint.string() + " exists, from an unfinished run",
                     "continue this run with --resume, or remove the file to start again");
}

/// Notes for after all checks of the inputs, immediately before the training replaces files.
std::vector<std::string> first_notes(const TrainOptions& options, const TrainingFiles& files,
                                     const Dataset& dataset) {
  std::vector<std::string> notes;
  std::error_code error;
  if (!options.resume && fs::exists(files.scene, error))
    notes.push_back(files.scene.string() +
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
      say(options.resume ? "interrupted before a step was complete; the checkpoint is unchanged"
                         : "interrupted before a step was complete; no checkpoint was written");
    throw;
  }
}

ExitCode train(const TrainOptions& options) {
  // Wrong arguments are reported before the photographs are read.
  const std::unique_ptr<TrainingMethod> method = make_training_method(options.training);
  TrainingFiles files;
  std::optional<trainer::RunLock> lock, log_lock;
  std::optional<trainer::RunControl> control;
  if (!options.print_config) {
    outlive_readers();  // a closed pipe must not end hours of training
    files = files_of(options);
    check_writable(files);
    lock.emplace(files.lock);
    if (!options.log.empty()) log_lock.emplace(fs::path(files.log) += ".lock");
    check_existing(options, files);
    control.emplace(trainer::control_file(files.log));
    if (options.preview_every > 0) make_folder(files.previews);
  }
  if (options.resume) method->resume(files.checkpoint);
  method->settle(nullptr);
  const std::optional<Scene> start = before_the_first_step(options, [&] {
    return options.resume || options.print_config ? std::nullopt
                                                  : read_start(options.training, *method);
  });

  Dataset dataset =
      before_the_first_step(options, [&] { return read(options.dataset, DatasetPart::all); });
  check_images(options, dataset);
  method->settle(&dataset);
  if (options.print_config) {
    print_text(method->constants());
    return ExitCode::done;
  }
  say_list("Reading " + options.dataset.path + ":", notes_of(dataset.remarks));

  Progress::Output output = Progress::standard_error();
  output.line_seconds = 10;
  std::optional<Progress> progress;
  TrainingOutcome result;
  TrainingWindow window(options, files);
  trainer::RunRequest run{
      .name = fs::path(options.output).stem().string(),
      .threads = options.threads,
      .session = {.checkpoint = files.checkpoint,
                  .log = files.log,
                  .previews = files.previews,
                  .checkpoint_every = options.checkpoint_every,
                  .preview_every = options.preview_every,
                  .control = &*control,
                  .progress =
                      [&](const trainer::SessionStatus& now) {
                        if (!progress) progress.emplace("training", output);
                        progress->update(double(now.step) / now.steps, describe(now));
                      },
                  .interrupted =
                      [&](const trainer::SessionStatus& now) {
                        progress.reset();
                        say(
                            fmt::format("wrote {} after step {} of {}; the same command with "
                                        "--resume continues from it",
                                        files.checkpoint.string(), counted(std::uint64_t(now.step)),
                                        counted(std::uint64_t(now.steps))));
                      }},
      .finished =
          [&](const Scene& scene) {
            progress.reset();
            write_results(options, files, scene, result);
          },
      .measuring =
          [&](double fraction) {
            if (!progress) progress.emplace("measuring");
            progress->update(fraction);
          },
      .evaluate =
          [&](const Scene& scene) {
            progress.reset();
            Progress evaluating("evaluating");
            evaluate(result, scene, dataset.test,
                     [&](double fraction) { evaluating.update(fraction); });
          }};
  run.preparing = [&](double fraction) {
    before_the_first_step(options, [&] {
      if (!progress) progress.emplace("Gaussians for the first triangles", output);
      try {
        progress->update(fraction);
      } catch (const Interrupted&) {
        progress.reset();
        throw;
      }
    });
  };
  if (options.watch) run.snapshot = [&](const Scene& scene) { window.show(scene); };
  std::vector<std::string> notes = first_notes(options, files, dataset);
  const auto say_checked = [&](const std::string& sentence) {
    progress.reset();
    for (const std::string& note : std::exchange(notes, {})) say(note);
    say(sentence);
  };
  result.training = method->train(dataset, start ? &*start : nullptr, std::move(run), say_checked);
  if (!result.evaluation && !dataset.test.empty())
    say("The runtime cannot draw the scene here; the metrics are from the trainer's own "
        "renderer: " +
        result.why_not_drawn);
  say_result(options, dataset, result);
  if (options.json) print_json_line(to_json(result, dataset.test.size()));
  return ExitCode::done;
}

void add_file_options(Command& command, TrainOptions& options) {
  command.add_option("-o,--output", options.output, "scene to write").value_name("OUT.glb");
  command
      .add_option(
          "--log", options.log,
          "training log to write, JSON lines; OUT.jsonl by default (tureen report plots it)")
      .value_name("FILE");
  command
      .add_option("--checkpoint-every", options.checkpoint_every,
                  "steps between checkpoints in OUT.checkpoint; every two minutes by default")
      .check(between(1, 10'000'000))
      .value_name("N");
  command.add_flag(
      "--resume", options.resume,
      "continue from OUT.checkpoint; the scene is the same as without the interruption");
  command
      .add_option(
          "--preview-every", options.preview_every,
          "steps between previews; a preview is an image in the folder OUT.previews: a test "
          "view beside its photograph; no previews by default; also a video, OUT-previews.mp4, if "
          "ffmpeg is installed")
      .check(between(1, 10'000'000))
      .value_name("N");
  command.add_flag("--watch", options.watch,
                   "show the training in a window: the scene, curves, pause, stop and keep; the "
                   "window's scene is OUT.watch.glb");
  command
      .add_option("--export-diffsoup", options.diffsoup_export,
                  "also write a folder for DiffSoup's web viewer")
      .value_name("FOLDER");
}

}  // namespace

void add_train(Command& program) {
  auto options = std::make_shared<TrainOptions>();
  Command command = program.add_command("train", "Train a scene from photographs");
  command.footer(
      R"(Trains a scene to match the photographs: triangles with lattice textures and a color MLP
(--method diffsoup), Gaussians or, with --flat, discs (--method gaussians), or soft or opaque
triangles with one color each, which depends on the direction (--method triangles). Writes the scene
as OUT.glb and a log as OUT.jsonl, and measures the scene on the test views. Ctrl-C writes a
checkpoint; --resume continues from it. Equal seeds give equal scenes on a CPU, with any number of
threads. For gaussians and triangles, --max-memory also limits the number of splats.

Examples:
  tureen train lego -o lego.glb
  tureen train fox -o fox.glb --scale 0.25 --steps 5000      fast, with smaller photographs
  tureen train fox -o fox.glb --scale 0.25 --resume          after Ctrl-C
  tureen train lego -o lego.glb --method gaussians --minutes 5   as much as 5 minutes allow
  tureen train lego -o lego.glb --method triangles --opaque    a soup with one color each
  tureen train lego -o lego.glb --preview-every 500          write previews
  tureen train lego -o lego.glb --watch                      show the training in a window
  tureen train lego -o better.glb --init lego.glb            continue from a trained soup
  tureen train lego --print-config > lego.json               all constants, for --config

Exit codes: 0 done, 2 wrong usage, or --resume with another dataset or other constants,
3 the photographs, the checkpoint or the configuration cannot be read,
4 no GPU for --device cuda, 5 interrupted, or the scene cannot be written.)");
  add_dataset_argument(command, options->dataset);
  add_memory_option(command,
                    [options](std::uint64_t bytes) { options->training.max_memory = bytes; });
  add_file_options(command, *options);
  add_config_options(command, options->training);
  add_choice<trainer::Device>(
      command, "--device", options->training.device,
      {{"auto", trainer::Device::automatic},
       {"cpu", trainer::Device::cpu},
       {"cuda", trainer::Device::cuda}},
      "device for training: auto (default: a GPU if available), cpu or cuda")
      .value_name("NAME");
  command
      .add_option("--threads", options->threads,
                  "number of processor threads; one per core by default")
      .check(between(1, 1024))
      .value_name("N");
  command.add_flag("--print-config", options->print_config,
                   "print all constants of this run as JSON, without training");
  command.add_text_flag(
      "--list-config", [options] { return constants_reference(options->training); },
      "list all constants of the method with their defaults, ranges and meanings, and exit");
  command.add_flag("--json", options->json,
                   "print the result as one line of JSON to standard output");
  command.does([options] { return train(*options); });
}

}  // namespace tureen::cli
