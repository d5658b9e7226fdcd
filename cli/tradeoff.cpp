// `tureen tradeoff`: what drawing faster costs, and the cheapest way that nobody sees.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "cli/choice.hpp"
#include "cli/commands.hpp"
#include "cli/dataset_argument.hpp"
#include "cli/interrupt.hpp"
#include "cli/memory_option.hpp"
#include "cli/number_range.hpp"
#include "cli/output_argument.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/report_page.hpp"
#include "cli/scene_argument.hpp"
#include "cli/tradeoff_model.hpp"
#include "cli/tradeoff_report.hpp"
#include "cli/tradeoff_study.hpp"
#include "cli/tradeoff_views.hpp"
#include "cli/version.hpp"
#include "formats/extension.hpp"
#include "formats/output.hpp"
#include "runtime/benchmark.hpp"
#include "runtime/preset_check.hpp"
#include "runtime/tradeoff/reference.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* steady_clock =
    "steady clock of the processor, from an idle device until it has finished";
constexpr const char* processor_clock =
    "processor time of all threads, not time that passed: for ratios on a busy machine";

/// How much is measured, where nothing more precise is said.
enum class Effort { quick, normal, full };

struct Defaults {
  std::string size;
  DefaultViews views;
  int rounds;
  int combinations;
  int samples;      // an axis
  int photographs;  // 0: all
};

Defaults defaults_of(Effort effort) {
  switch (effort) {
    case Effort::quick:
      return {"96x64", {.count = 2}, 1, 4, 2, 2};
    case Effort::normal:
      return {"480x270", {.count = 4}, 3, 48, 4, 8};
    case Effort::full:
      return {"1280x720", {.count = 8, .adversarial = true}, 5, 256, 8, 0};
  }
  return {};
}

struct Options {
  SceneArgument scene;
  DatasetArgument dataset;
  gl::Backend backend = gl::Backend::automatic;
  Effort effort = Effort::normal;
  std::string size;
  std::vector<std::string> cameras;  // empty: by the effort
  int rounds = 0, photographs = 0;   // 0: by the effort
  int combinations = -1;             // the same
  tradeoff::Samples samples = tradeoff::Samples::device;
  tradeoff::Limits limits;
  bool with_flip = true;
  bool processor_time = false;
  std::string folder;
  std::string preset_file;
  bool write_preset = false;
  bool force = false;
  bool json = false;
  std::vector<std::string> arguments;  // of the program, as typed
};

/// Where --write-preset writes: what was given, or NAME.preset.glb beside the scene.
fs::path preset_path(const Options& options) {
  if (!options.preset_file.empty()) return options.preset_file;
  fs::path path = options.scene.path;
  if (!path.has_filename()) path = path.parent_path();
  return path.replace_extension(".preset.glb");
}

/// Said before anything is measured: minutes of work must not end in a refusal.
void require_writable_outputs(const Options& options) {
  if (!options.folder.empty()) require_writable_folder(options.folder);
  if (!options.write_preset) return;
  const fs::path path = preset_path(options);
  if (extension_of(path) != ".glb")
    throw UsageError("'" + path.string() + "' does not end in .glb; presets are kept in our GLB");
  std::error_code error;
  if (fs::equivalent(path, options.scene.path, error))
    throw UsageError(path.string() + " is the scene itself, which stays as it is",
                     "name another file");
  if (fs::exists(path, error) && !options.force)
    throw UsageError(path.string() + " exists", "name another file, or give --force to replace it");
  require_writable_file(path);
}

void write_files(const Options& options, TradeoffReport& report) {
  if (options.folder.empty()) return;
  for (const fs::path& file : result_files(options.folder, "tradeoff"))
    report.output.push_back(file.string());
  write_result(options.folder, "tradeoff", json_text(to_json(report)));
}

/// The scene as a GLB of ours that promises what was measured.
void write_chosen_preset(const Options& options, Scene& scene, TradeoffReport& report) {
  if (!options.write_preset) return;
  if (!report.study.choice) return;
  const Outcome& chosen = report.study.drawing.outcomes[*report.study.choice];
  scene.preset = chosen.preset;
  scene.preset->promised_psnr_db = report.promised_psnr_db;
  const fs::path path = preset_path(options);
  std::vector<std::string> sentences = write_scene(scene, path);
  if (is_faithful(chosen.preset))
    sentences.push_back("no knob is turned: nothing cheaper was within the bounds");
  say_list("Writing " + path.string() + ":", sentences);
  report.preset_written = path.string();
  report.output.push_back(path.string());
}

BenchViewOptions view_options(const Options& options, const Defaults& defaults) {
  BenchViewOptions views;
  views.cameras = options.cameras;
  if (std::count(views.cameras.begin(), views.cameras.end(), "dataset") > 0)
    views.dataset = options.dataset.path;
  views.sizes = {options.size.empty() ? defaults.size : options.size};
  return views;
}

/// What the model is held against, `most` of them; none without a dataset. Read before anything is
/// measured: minutes of work must not end in a refusal.
std::vector<Photograph> test_photographs(const Options& options, std::size_t most,
                                         TradeoffReport& report) {
  if (options.dataset.path.empty()) return {};
  Dataset dataset = read(options.dataset, DatasetPart::test);
  std::vector<Photograph> photographs = spread_out(std::move(dataset.test), most);
  if (photographs.empty())
    throw InputError({options.dataset.path, {}, {}}, "it holds no photographs to test with");
  for (std::string& note : described(dataset.remarks)) report.notes.push_back(std::move(note));
  return photographs;
}

void measure_models(const Options& options, const Scene& scene, const TriangleSoup& soup,
                    const std::vector<Photograph>& photographs, TradeoffReport& report) {
  if (photographs.empty()) return;
  report.model = {options.dataset.path, "test", int(photographs.size()), name(SsimBorder::valid)};
  Progress progress("photographs");
  ModelOptions model{.backend = options.backend,
                     .background = scene.info.background,
                     .with_flip = options.with_flip};
  // What is emulated may take as long as that reference did, and no longer.
  constexpr int samples = tradeoff::antialiased_samples * tradeoff::antialiased_samples;
  model.most_oracle_pixels = double(report.views) * report.width * report.height * samples;
  Panel& drawing = report.study.drawing;
  if (auto note = why_not_emulated(drawing, photographs, model.most_oracle_pixels))
    drawing.notes.push_back(*std::move(note));
  model.progress = [&](double fraction) { progress.update(0.8 * fraction); };
  report.drawing_model = model_errors(drawing, soup, scene.origin, photographs, model);
  model.progress = [&](double fraction) { progress.update(0.8 + 0.2 * fraction); };
  report.antialiasing_model =
      model_errors(report.study.antialiasing, soup, scene.origin, photographs, model);
}

/// The cheapest within the limits that keeps to them on the four views, too, at which a preset is
/// checked when it is obeyed: others than those that were measured.
void choose(const gl::Context& context, const Scene& scene, Study& study, TradeoffReport& report) {
  Candidates left = candidates(study.drawing);
  while (const auto cheapest = tradeoff::cheapest_within(left.points, report.limits)) {
    throw_if_interrupted();
    const Outcome& outcome = study.drawing.outcomes[left.index[*cheapest]];
    const double promised = measured_promise(context, scene, outcome.preset);
    if (promised >= report.limits.least_psnr_db) {
      study.choice = left.index[*cheapest];
      report.promised_psnr_db = promised;
      return;
    }
    study.drawing.notes.push_back(fmt::format(
        "{} is not chosen: on four other views it comes within {:.1f} dB of faithful pictures only",
        outcome.name, promised));
    left.points.erase(left.points.begin() + std::ptrdiff_t(*cheapest));
    left.index.erase(left.index.begin() + std::ptrdiff_t(*cheapest));
  }
}

Study study_of(const Options& options, const Defaults& defaults, const Scene& scene,
               const TriangleSoup& soup, TradeoffReport& report) {
  report.rounds = options.rounds > 0 ? options.rounds : defaults.rounds;
  const TradeoffViews views =
      tradeoff_views(view_options(options, defaults), defaults.views, scene, options.scene.path);
  report.notes.insert(report.notes.end(), views.notes.begin(), views.notes.end());
  report.camera_set = views.camera_set;
  report.views = int(views.judges.size());
  report.width = views.judges.front().width;
  report.height = views.judges.front().height;

  const gl::Context context = gl::Context::create({.backend = options.backend});
  const gl::Capabilities& device = context.capabilities();
  report.device.context = context.description();
  report.device.renderer = device.renderer;
  report.device.vendor = device.vendor;
  report.device.version = device.version;
  report.device.software = device.software;
  report.clock = options.processor_time ? processor_clock : steady_clock;
  if (options.processor_time && !device.software)
    throw UsageError("--processor-time says nothing of " + device.renderer +
                     ", which is no software renderer");
  StudyOptions study{.subpixel_bits = tradeoff::device_subpixel_bits()};
  if (study.subpixel_bits != 8)
    report.notes.push_back(fmt::format(
        "this device rounds vertices to 1/{} pixel, and so does the oracle where it samples as the "
        "device does; E_render is not that of devices with the usual 1/256",
        1 << study.subpixel_bits));
  if (options.processor_time) study.clock = processor_seconds;
  study.background = scene.info.background;
  study.samples = options.samples;
  study.rounds = report.rounds;
  study.factorial.most_configurations =
      std::size_t(options.combinations >= 0 ? options.combinations : defaults.combinations);
  study.most_samples = defaults.samples;
  study.with_flip = options.with_flip;
  std::optional<Progress> progress;
  std::string task;
  study.progress = [&](const std::string& now, double fraction) {
    if (now != task) {
      progress.reset();
      progress.emplace(now);
      task = now;
    }
    progress->update(fraction);
  };
  Study found = run_study({context, soup, scene.origin, views.judges, views.counting}, study);
  progress.reset();
  choose(context, scene, found, report);
  return found;
}

ExitCode tradeoff(const Options& options) {
  // Everything that can be wrong with the arguments is said before anything is read.
  const Defaults defaults = defaults_of(options.effort);
  check(view_options(options, defaults));
  require_writable_outputs(options);

  Scene scene = read(options.scene);
  const TriangleSoup& soup = opaque_soup(scene);
  TradeoffReport report;
  report.notes = all_notes(scene.info);
  if (scene.preset && !is_faithful(*scene.preset))
    report.notes.push_back("the scene's own preset is put aside: every knob begins at its default");
  report.date = utc_now();
  report.program = {program_version(), program_commit(), options.arguments};
  report.scene = {scene.info.name, options.scene.path, soup.triangles.size(),
                  appearance_name(soup.appearance)};
  report.machine = this_machine();
  report.with_flip = options.with_flip;
  report.samples = options.samples == tradeoff::Samples::device ? "device" : "exact";
  report.limits = options.limits;
  const int most = options.photographs > 0 ? options.photographs : defaults.photographs;
  const auto photographs = test_photographs(options, std::size_t(most), report);
  report.study = study_of(options, defaults, scene, soup, report);
  measure_models(options, scene, soup, photographs, report);
  write_chosen_preset(options, scene, report);
  write_files(options, report);

  say_list("Reading:", report.notes);
  say(fmt::format("{} triangles, {} views of {} x {}, on {} ({})", counted(soup.triangles.size()),
                  report.views, report.width, report.height, report.device.renderer,
                  report.device.context));
  say_tables(report);
  for (const std::string& path : report.output) say("wrote " + path);
  if (options.json) print_json(to_json(report));
  return options.write_preset && !report.preset_written ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

void add_tradeoff(CLI::App& program, Action& action, std::vector<std::string> arguments) {
  auto options = std::make_shared<Options>();
  options->arguments = std::move(arguments);
  CLI::App* command = program.add_subcommand("tradeoff", "Error against run time, and the choice");
  command->footer(
      R"(Turns one knob of drawing at a time, then those that matter together, and measures for
each the time of a frame and the error against the oracle's picture of the same model
(E_render). Antialiasing knobs have an oracle of their own, with 8 x 8 samples a pixel. With
photographs the error against them (E_model) stands beside, never on one axis, and that of the
published pipeline with it. The choice is the cheapest with an E_render of at least 50 dB and
hardly a pixel covered wrongly.

Examples:
  tureen tradeoff soup.glb -o tradeoff                report.html and tradeoff.json
  tureen tradeoff soup.glb lego --scale 0.5 -o tradeoff
                                                      with E_model against photographs
  tureen tradeoff soup.glb --write-preset fast.glb    the scene with the choice, as another
                                                      file; tureen render fast.glb obeys it
  tureen tradeoff soup.glb --full --json > soup.json  1280x720, all settings: long

Exit codes: 0 done, 1 nothing keeps to the limits and a preset was asked for, 2 wrong usage,
3 the scene or the dataset cannot be read, 4 no OpenGL context, 5 it does not fit
on the device or cannot be written.)");
  add_scene_argument(*command, options->scene);
  add_dataset_argument(*command, options->dataset);
  command->get_option("DATASET")->required(false);
  add_memory_option(*command);
  command->add_option("-o,--output", options->folder, "a folder for report.html and tradeoff.json")
      ->option_text("FOLDER");
  add_choice<tradeoff::Samples>(
      *command, "--reference", options->samples,
      {{"device", tradeoff::Samples::device}, {"exact", tradeoff::Samples::exact}},
      "what drawing knobs are measured against: the oracle at the device's sample points "
      "(default), or of exact triangles, which adds what the device rounds")
      ->option_text("NAME");
  auto* full = command->add_flag_callback(
      "--full", [options] { options->effort = Effort::full; },
      "1280x720, 8 views and 4 adversarial ones, 5 rounds, 8 x 8 samples, all photographs; "
      "480x270, 4 views, 3 rounds, 4 x 4 samples and 8 photographs by default");
  command
      ->add_flag_callback(
          "--quick", [options] { options->effort = Effort::quick; },
          "96x64, 2 views, 1 round: whether it works at all")
      ->excludes(full);
  command->add_option("--size", options->size, "of the pictures, in pixels")->option_text("WxH");
  command
      ->add_option("--cameras", options->cameras,
                   "the views, of one set or several: hemisphere:N, orbit:N, adversarial, dataset "
                   "(its test cameras), or a file of cameras; 4 of the scene's own by default, or "
                   "hemisphere:4 where it has none")
      ->option_text("SET[,SET..]")
      ->delimiter(',');
  command->add_option("--rounds", options->rounds, "how often all views are gone through")
      ->check(between(1, 1000))
      ->option_text("N");
  command
      ->add_option("--combinations", options->combinations,
                   "at most so many combinations of the knobs that matter, of drawing and of "
                   "antialiasing ones each, 48 by default; 0 turns one knob at a time")
      ->check(between(0, 10000))
      ->option_text("N");
  command
      ->add_option("--photographs", options->photographs,
                   "at most so many of the dataset's test photographs, evenly spread")
      ->check(between(1, 1000000))
      ->option_text("N");
  command
      ->add_option("--least-psnr", options->limits.least_psnr_db,
                   "E_render in dB that the choice keeps, 50 by default")
      ->check(between(0.0, 100.0))
      ->option_text("DB");
  command
      ->add_option("--most-mismatch", options->limits.most_coverage_mismatch,
                   "the part of the pixels that the choice may cover wrongly, 1e-4 by default")
      ->check(between(0.0, 1.0))
      ->option_text("FRACTION");
  CLI::Option* preset =
      command
          ->add_option("--write-preset", options->preset_file,
                       "the scene with the choice and what it promises, as a GLB of ours; "
                       "SCENE.preset.glb by default")
          ->expected(0, 1)
          ->option_text("[OUT.glb]");
  command->add_flag("--force", options->force, "--write-preset may replace a file");
  command->add_flag_callback(
      "--no-flip", [options] { options->with_flip = false; },
      "leave FLIP out, which takes most of the time of comparing");
  command->add_flag("--processor-time", options->processor_time,
                    "processor time of all threads instead of time that passed: for ratios on a "
                    "busy machine, of software renderers alone");
  add_choice<gl::Backend>(*command, "--context", options->backend,
                          {{"auto", gl::Backend::automatic},
                           {"egl", gl::Backend::egl},
                           {"osmesa", gl::Backend::osmesa}},
                          "where OpenGL comes from: auto (EGL, else OSMesa), egl or osmesa")
      ->option_text("NAME");
  command->add_flag("--json", options->json, "everything as JSON on standard output");
  command->callback([options, preset, &action] {
    options->write_preset = preset->count() > 0;  // with or without a name
    action = [options] { return tradeoff(*options); };
  });
}

}  // namespace tureen::cli
