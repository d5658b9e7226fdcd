// `tureen train`: trains a soup from photographs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <utility>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "base/suggestion.hpp"
#include "cli/commands.hpp"
#include "cli/files/eval_images.hpp"
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
#include "jobs/eval/evaluation.hpp"
#include "trainer/common/kernels/projection.hpp"
#include "trainer/common/run_control.hpp"
#include "trainer/common/run_lock.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/diffsoup/config_fields.hpp"
#include "trainer/diffsoup/config_file.hpp"
#include "trainer/diffsoup/device.hpp"
#include "trainer/diffsoup/training.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;
using trainer::Checkpoint;
using trainer::Config;
using trainer::Device;
using trainer::Preset;

struct TrainOptions {
  DatasetArgument dataset;
  ConfigOptions config;
  std::string output;
  std::string log;              // empty: beside the output
  std::string diffsoup_export;  // empty: none
  Device device = Device::automatic;
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
  TrainingFiles files = training_files(options.output);
  if (!options.log.empty()) files.log = options.log;
  fs::path folder = options.diffsoup_export;
  if (!folder.empty() && !folder.has_filename()) folder = folder.parent_path();  // ends in '/'
  files.diffsoup_export = folder;
  return files;
}

Preset preset_for(const Dataset& dataset) {
  return dataset.has_alpha ? Preset::object : Preset::scene;
}

/// The constants of this run. A resumed run has the constants of its checkpoint; constants on the
/// command line must equal them.
Config config_of(const TrainOptions& options, Preset otherwise, const Checkpoint* checkpoint) {
  const bool is_new = !checkpoint || options.config.name_a_base();
  const Config base = is_new ? base_config(options.config, otherwise) : checkpoint->config;
  const Config config = with_options(base, options.config);
  if (checkpoint)
    if (const auto reason = difference(config, checkpoint->config))
      throw UsageError("--resume needs the configuration of the checkpoint: " + *reason);
  if (config.initialisation == trainer::Initialisation::mesh && !checkpoint &&
      options.config.mesh().empty())
    throw UsageError("initialisation \"mesh\" needs a scene", "name its file with --init FILE");
  return config;
}

void check_images(const TrainOptions& options, const Dataset& dataset) {
  require_sides(options.dataset, dataset,
                {.least = ssim_window, .most = trainer::kernels::max_image_side});
}

std::string progress_text(const trainer::SessionStatus& now) {
  std::string text = fmt::format("{}{}/{}", now.paused ? "paused, " : "", now.step, now.steps);
  if (now.loss > 0) text += fmt::format(", loss {:.4f}", now.loss);
  if (now.test_psnr_db) text += fmt::format(", {:.2f} dB", *now.test_psnr_db);
  if (now.seconds_per_step > 0)
    text += fmt::format(", {:.3g} it/s, {} left", 1 / now.seconds_per_step,
                        duration_text(now.seconds_per_step * (now.steps - now.step)));
  return text;
}

struct Result {
  trainer::TrainingResult training;
  std::optional<Evaluation> evaluation;  // none without OpenGL
  std::vector<std::string> output;
};

/// Writes the soup and the DiffSoup export, then removes the checkpoint.
void write_results(const TrainingFiles& files, const Scene& scene, Result& result) {
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
}

/// Metrics of the runtime's images, which users will see; empty if the runtime cannot draw them
/// here.
std::optional<Evaluation> evaluation_of(const Scene& scene, std::span<const Photograph> views) {
  Progress progress("evaluating");
  EvaluationOptions options;
  options.background = scene.info.background;
  options.progress = [&](double fraction) { progress.update(fraction); };
  std::string reason;
  try {
    return evaluate(scene, views, options);
  } catch (const ContextError& error) {
    reason = error.reason();
  } catch (const DeviceLimitError& error) {
    reason = error.reason();
  }
  say("The runtime cannot draw the soup here; the metrics are from the trainer's own renderer: " +
      reason);
  return std::nullopt;
}

void say_result(const TrainOptions& options, const Dataset& dataset, const Result& result) {
  const trainer::TrainingState& state = result.training.state;
  say(fmt::format(
      "{} triangles after {} steps in {}; {:.1f} % of the texels are transparent or "
      "opaque",
      counted(state.model.faces()), counted(std::uint64_t(state.step)),
      duration_text(result.training.seconds), 100 * result.training.opacity_binary_fraction));
  if (state.non_finite > 0)
    say(fmt::format("{} non-finite numbers were skipped", counted(state.non_finite)));
  Table table({counted(dataset.test.size()) + " test views", "PSNR dB", "SSIM", "FLIP"});
  table.row({"drawn by the trainer", fmt::format("{:.2f}", result.training.test_psnr_db)});
  if (result.evaluation) {
    const ViewMetrics& mean = result.evaluation->mean;
    table.row({options.output, fmt::format("{:.2f}", mean.psnr_db),
               fmt::format("{:.4f}", mean.ssim), fmt::format("{:.4f}", mean.flip)});
  }
  for (const std::string& line : table.lines()) say(line);
  for (const std::string& path : result.output) say("wrote " + path);
}

Json report(const Dataset& dataset, const Result& result) {
  Json test{{"views", dataset.test.size()}};
  if (result.evaluation) {
    test.update(cli::to_json(result.evaluation->mean, true));
    test["drawn_by"] = result.evaluation->renderer;
  } else {
    test["psnr_db"] = result.training.test_psnr_db;
    test["drawn_by"] = "trainer";
  }
  return {{"done", true},
          {"steps", result.training.state.step},
          {"seconds", result.training.seconds},
          {"triangles", result.training.state.model.faces()},
          {"visible_at_start", result.training.visible_at_start},
          {"test", test},
          {"trainer_psnr_db", result.training.test_psnr_db},
          {"opacity_binary_fraction", result.training.opacity_binary_fraction},
          {"non_finite", result.training.state.non_finite},
          {"output", result.output}};
}

void say_beginning(const Dataset& dataset, const Config& config, const trainer::Backend& backend) {
  const Camera& first = dataset.train.front().camera;
  say(
      fmt::format("{} training views and {} test views, the first {} x {}; {} steps to {} "
                  "triangles; {}",
                  counted(dataset.train.size()), counted(dataset.test.size()), first.width,
                  first.height, counted(std::uint64_t(config.steps)),
                  counted(std::uint64_t(config.triangles)), backend.description()));
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
std::optional<Scene> read_mesh(const ConfigOptions& options) {
  const fs::path path = options.mesh();
  if (path.empty()) return std::nullopt;
  const std::vector<std::string> words{"random", "points"};
  if (is_missing(path))
    throw InputError({path.string(), {}, {}},
                     why_missing(path) + "; --init takes random, points or a scene",
                     did_you_mean(path.string(), words));
  return read_one_layer(SceneArgument{.path = path.string()});
}

/// Throws UsageError if the run would replace an existing file by mistake.
void check_existing(const TrainOptions& options, const TrainingFiles& files) {
  std::error_code error;
  if (const fs::path mesh = options.config.mesh(); fs::equivalent(mesh, files.scene, error))
    throw UsageError("-o would replace " + mesh.string() + ", the scene for --init",
                     "choose another name");
  if (!options.resume && fs::exists(files.scene, error))
    say(files.scene.string() + " exists; training replaces its log now and the file at the end");
  if (!options.resume && fs::exists(files.checkpoint, error))
    throw UsageError(files.checkpoint.string() + " exists, from an unfinished run",
                     "continue this run with --resume, or remove the file to start again");
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
    trainer::require_device(options.device);
    if (options.preview_every > 0) make_folder(files.previews);
  }
  std::optional<Checkpoint> checkpoint;
  if (options.resume) checkpoint = trainer::read_checkpoint(files.checkpoint);
  const Checkpoint* before = checkpoint ? &*checkpoint : nullptr;
  config_of(options, Preset::object, before);
  const std::optional<Scene> mesh = before_the_first_step(options, [&] {
    return checkpoint || options.print_config ? std::nullopt : read_mesh(options.config);
  });

  Dataset dataset =
      before_the_first_step(options, [&] { return read(options.dataset, DatasetPart::all); });
  check_images(options, dataset);
  const Config config = config_of(options, preset_for(dataset), before);
  if (options.print_config) {
    print_text(trainer::config_to_json(config));
    return ExitCode::done;
  }
  say_list("Reading " + options.dataset.path + ":", described(dataset.remarks));
  if (!checkpoint && !options.config.preset && options.config.file.empty())
    say(dataset.has_alpha ? "The images have alpha: --preset object"
                          : "The images have no alpha: --preset scene");

  if (checkpoint)
    if (const auto reason = difference(trainer::fingerprint(dataset.train), checkpoint->views))
      throw UsageError("--resume needs the dataset of the checkpoint: " + *reason);
  Progress::Output output = Progress::standard_error();
  output.line_seconds = 10;
  std::optional<Progress> progress;
  Result result;
  TrainingWindow window(options, files);
  std::function<void(const Scene&)> snapshot;
  if (options.watch) snapshot = [&](const Scene& scene) { window.show(scene); };
  result.training = trainer::train(
      dataset,
      {.config = config,
       .name = fs::path(options.output).stem().string(),
       .mesh = mesh ? &*mesh : nullptr,
       .checkpoint = std::move(checkpoint),
       .device = options.device,
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
                         progress->update(double(now.step) / now.steps, progress_text(now));
                       },
                   .interrupted =
                       [&](int step) {
                         progress.reset();
                         say(
                             fmt::format("wrote {} after step {} of {}; the same command with "
                                         "--resume continues from it",
                                         files.checkpoint.string(), counted(std::uint64_t(step)),
                                         counted(std::uint64_t(config.steps))));
                       }},
       .begun =
           [&](const trainer::Backend& backend, bool visible) {
             say_beginning(dataset, config, backend);
             if (!visible)
               say("No training image shows a triangle yet: check the cameras of the dataset.");
           },
       .snapshot = snapshot,
       .finished =
           [&](const Scene& scene) {
             progress.reset();
             write_results(files, scene, result);
           },
       .measuring =
           [&](double fraction) {
             if (!progress) progress.emplace("measuring");
             progress->update(fraction);
           },
       .evaluate =
           [&](const Scene& scene) {
             progress.reset();
             result.evaluation = evaluation_of(scene, dataset.test);
           }});
  say_result(options, dataset, result);
  if (options.json) print_json_line(report(dataset, result));
  return ExitCode::done;
}

void add_file_options(Command& command, TrainOptions& options) {
  command.add_option("-o,--output", options.output, "soup to write").value_name("OUT.glb");
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
      "continue from OUT.checkpoint; the soup is the same as without the interruption");
  command
      .add_option(
          "--preview-every", options.preview_every,
          "steps between previews; a preview is an image in the folder OUT.previews: a test "
          "view beside its photograph; no previews by default")
      .check(between(1, 10'000'000))
      .value_name("N");
  command.add_flag("--watch", options.watch,
                   "show the training in a window: the soup, curves, pause, stop and keep; the "
                   "window's scene is OUT.watch.glb");
  command
      .add_option("--export-diffsoup", options.diffsoup_export,
                  "also write a folder for DiffSoup's web viewer")
      .value_name("FOLDER");
}

}  // namespace

void add_train(Command& program) {
  auto options = std::make_shared<TrainOptions>();
  Command command = program.add_command("train", "Train a soup from photographs");
  command.footer(
      R"(Trains triangles with lattice textures and a color MLP to match the photographs. Writes the
soup as OUT.glb and a log as OUT.jsonl, and measures the soup on the test views. Ctrl-C writes
a checkpoint; --resume continues from it. Equal seeds give equal soups on a CPU, with any
number of threads.

Examples:
  tureen train lego -o lego.glb
  tureen train fox -o fox.glb --scale 0.25 --steps 5000      fast, with smaller photographs
  tureen train fox -o fox.glb --scale 0.25 --resume          after Ctrl-C
  tureen train lego -o lego.glb --preview-every 500          write previews
  tureen train lego -o lego.glb --watch                      show the training in a window
  tureen train lego -o better.glb --init lego.glb            continue from a trained soup
  tureen train lego --print-config > lego.json               all constants, for --config

Exit codes: 0 done, 2 wrong usage, or --resume with another dataset or other constants,
3 the photographs, the checkpoint or the configuration cannot be read,
4 no GPU for --device cuda, 5 interrupted, or the soup cannot be written.)");
  add_dataset_argument(command, options->dataset);
  add_memory_option(command);
  add_file_options(command, *options);
  add_config_options(command, options->config);
  add_choice<Device>(command, "--device", options->device,
                     {{"auto", Device::automatic}, {"cpu", Device::cpu}, {"cuda", Device::cuda}},
                     "device for training: auto (default: a GPU if available), cpu or cuda")
      .value_name("NAME");
  command
      .add_option("--threads", options->threads,
                  "number of processor threads; one per core by default")
      .check(between(1, 1024))
      .value_name("N");
  command.add_flag("--print-config", options->print_config,
                   "print all constants of this run as JSON, without training");
  command.add_text_flag("--list-config", trainer::config_reference,
                        "list all constants with their defaults, ranges and meanings, and exit");
  command.add_flag("--json", options->json,
                   "print the result as one line of JSON to standard output");
  command.does([options] { return train(*options); });
}

}  // namespace tureen::cli
