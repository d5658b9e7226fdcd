// `tureen tradeoff`: error against frame time, and the cheapest configuration within limits.
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "cli/commands.hpp"
#include "cli/files/result_files.hpp"
#include "cli/options/arguments.hpp"
#include "cli/options/drawing_options.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/tradeoff/tradeoff_run.hpp"
#include "cli/tradeoff/tradeoff_tables.hpp"
#include "formats/scene_file.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct TradeoffArguments : TradeoffOptions {
  std::string folder;
  std::string written_scene;  // empty: none
  bool force = false;
  bool json = false;
};

/// Runs before anything is measured, so that an error does not cost minutes of work. Throws
/// UsageError if `path` does not end in .glb, is `scene`, or exists without `replaces`; OutputError
/// if it cannot be written.
void require_writable_scene(const fs::path& path, const fs::path& scene, bool replaces) {
  if (extension_of(path) != ".glb")
    throw UsageError("'" + path.string() + "' does not end in .glb; --write writes GLB files");
  std::error_code error;
  if (fs::equivalent(path, scene, error))
    throw UsageError(path.string() + " is also the input SCENE", "choose another name");
  if (fs::exists(path, error) && !replaces)
    throw UsageError(path.string() + " exists", "choose another name, or replace it with --force");
  require_writable_file(path);
}

/// Writes a scene with one layer, which must hold a TriangleSoup, with the chosen edits as a Tureen
/// GLB, and adds its name to the report. Without a choice, does nothing.
void write_chosen(const fs::path& path, Scene scene, TradeoffReport& report) {
  if (!report.study.choice) return;
  const tradeoff::Applied& applied = report.study.drawing.outcomes[*report.study.choice].applied;
  std::vector<std::string> sentences;
  if (!has_edits(applied)) {
    sentences.emplace_back("without edits: no edit within the limits is measurably faster");
  } else {
    Progress progress("reducing the scene");
    scene = edited(std::move(scene), applied, [&](double done) { progress.update(done); });
    scene.info.notes.push_back("reduced by tureen tradeoff: " + describe_edits(applied));
  }
  if (splat_count(scene) > 0) scene.quality.splat_order = applied.quality.splat_order;
  const std::vector<std::string> losses = write_scene(scene, path);
  sentences.insert(sentences.end(), losses.begin(), losses.end());
  say_list("Writing " + path.string() + ":", sentences);
  report.scene_written = path.string();
  report.output.push_back(path.string());
}

void write_files(const TradeoffArguments& options, TradeoffReport& report) {
  if (options.folder.empty()) return;
  for (const fs::path& file : result_files(options.folder, "tradeoff"))
    report.output.push_back(file.string());
  write_result(options.folder, "tradeoff", json_text(results::to_json(report)));
}

ExitCode tradeoff(const TradeoffArguments& options) {
  // Wrong arguments are reported before anything is read.
  check(options);
  if (!options.folder.empty()) require_writable_folder(options.folder);
  if (!options.written_scene.empty())
    require_writable_scene(options.written_scene, options.scene.path, options.force);

  Scene scene = read_one_layer(options.scene);
  only_layer(scene).visible = true;
  TradeoffReport report = measure_tradeoff(options, scene);
  // If the scene cannot be written, the report is still written: measuring takes minutes.
  std::exception_ptr unwritten;
  if (!options.written_scene.empty()) try {
      write_chosen(options.written_scene, std::move(scene), report);
    } catch (const std::exception&) {
      unwritten = std::current_exception();
    }
  write_files(options, report);

  say_list("Reading:", report.notes);
  say(fmt::format("{}, {} views of {} x {}, on {} ({})",
                  primitives_text(report.scene.triangles, report.scene.splats), report.views,
                  report.width, report.height, report.device.renderer, report.device.context));
  say_tables(report);
  for (const std::string& path : report.output) say("wrote " + path);
  if (options.json) print_json(results::to_json(report));
  if (unwritten) std::rethrow_exception(unwritten);
  const bool lacks_choice = !options.written_scene.empty() && !report.scene_written;
  return lacks_choice ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

void add_tradeoff(Command& program, std::vector<std::string> arguments) {
  auto options = std::make_shared<TradeoffArguments>();
  options->arguments = std::move(arguments);
  Command command =
      program.add_command("tradeoff", "Measure error against frame time, and choose edits");
  command.footer(
      R"(Measures each edit and quality setting alone, then combinations of those that matter. Each
measurement has the frame time and E_render, the error against the oracle's image of the
unchanged scene. The reference for quality settings has 8 x 8 samples per pixel. With photographs,
the report also has the error against them (E_model), for the baseline too. The choice is the
fastest configuration within --least-psnr and --most-mismatch; of equally fast ones, the one with
the fewest changes. It never changes resolution or samples.
docs/tradeoff.md describes the method.

Examples:
  tureen tradeoff soup.glb -o tradeoff                report.html and tradeoff.json
  tureen tradeoff soup.glb lego --scale 0.5 -o tradeoff
                                                      with E_model against photographs
  tureen tradeoff soup.glb --write fast.glb           a new scene with the chosen edits
  tureen tradeoff soup.glb --full --json > soup.json  1280x720, all settings: slow

Exit codes: 0 done, 1 no configuration within the limits for --write, 2 wrong usage,
3 the scene or the dataset cannot be read, 4 no OpenGL context, 5 the scene does not fit
on the device, or the output cannot be written.)");
  add_scene_argument(command, options->scene);
  add_dataset_argument(command, options->dataset).required(false);
  add_memory_option(command);
  command.add_option("-o,--output FOLDER", options->folder,
                     "folder for report.html and tradeoff.json");
  add_choice<tradeoff::Samples>(
      command, "--reference NAME", options->samples,
      {{"device", tradeoff::Samples::device},
       {"exact", tradeoff::Samples::exact},
       {"trace", tradeoff::Samples::traced}},
      "reference for edits, drawn by the CPU in double precision: device (default, vertices "
      "rounded as on the device, splats in the order of their centres) or exact (vertices not "
      "rounded, splats in exact order; the error then includes the device's own), or trace (exact "
      "by rays, faster, splats in single precision)");
  const Option full = command.add_flag(
      "--full", [options] { options->effort = Effort::full; },
      "measure more: 1280x720, 8 views and 4 adversarial views, 5 rounds, up to 8 x 8 samples, all "
      "photographs; by default 480x270, 4 views, 3 rounds, up to 4 x 4 samples, 8 photographs");
  command
      .add_flag(
          "--quick", [options] { options->effort = Effort::quick; },
          "test run: 96x64, 2 views, 1 round")
      .excludes(full);
  command.add_option("--size WxH", options->size, "image size in pixels");
  command
      .add_option("--cameras SET[,SET..]", options->cameras,
                  "sets of views, separated by commas: hemisphere:N, orbit:N, adversarial, dataset "
                  "(its test cameras), or a file with cameras; by default 4 of the scene's own "
                  "cameras, or hemisphere:4 without cameras")
      .split_at_commas();
  command.add_option("--rounds N", options->rounds, "number of rounds over all views",
                     between(1, 1000));
  command.add_option(
      "--combinations N", options->combinations,
      "largest number of combinations, separately for edits and for quality settings: 48 each by "
      "default, 256 each with --full. With 0, only one edit or setting changes at a time",
      between(0, 10000));
  command.add_option("--photographs N", options->photographs,
                     "largest number of test photographs, chosen at even intervals from DATASET",
                     between(1, 1000000));
  command.add_option(
      "--least-psnr DB", options->limits.min_psnr_db,
      "limit for the choice: smallest PSNR against the oracle (E_render) in dB, 50 by default",
      between(0.0, 100.0));
  command.add_option(
      "--most-mismatch FRACTION", options->limits.max_coverage_mismatch,
      "limit for the choice: largest fraction of mismatched pixels, 1e-4 by default; a mismatched "
      "pixel is covered either in the device's image or in the reference, but not in both",
      between(0.0, 1.0));
  const Option write =
      command.add_option("--write OUT.glb", options->written_scene,
                         "GLB to write: the scene with the chosen edits; SCENE stays unchanged");
  command.add_flag("--force", options->force, "replace OUT.glb if it exists").needs(write);
  command.add_flag(
      "--no-flip", [options] { options->with_flip = false; },
      "do not compute FLIP; saves most of the time for the metrics");
  command.add_flag("--processor-time", options->processor_time,
                   "measure the CPU time of all threads instead of elapsed time, for ratios "
                   "on a busy machine; software OpenGL only");
  add_context_option(command, options->backend);
  command.add_flag("--json", options->json, "print the result as JSON to standard output");
  command.does([options] { return tradeoff(*options); });
}

}  // namespace tureen::cli
