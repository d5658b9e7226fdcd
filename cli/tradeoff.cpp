// `tureen tradeoff`: error against frame time, and the cheapest configuration within limits.
#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "base/output.hpp"
#include "cli/arguments.hpp"
#include "cli/commands.hpp"
#include "cli/drawing_options.hpp"
#include "cli/memory_option.hpp"
#include "cli/output_argument.hpp"
#include "cli/report.hpp"
#include "cli/report_page.hpp"
#include "cli/scene_argument.hpp"
#include "cli/tradeoff_report.hpp"
#include "cli/tradeoff_run.hpp"
#include "cli/tradeoff_write.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct TradeoffArguments : TradeoffOptions {
  std::string folder;
  std::string written_scene;  // empty: none is written
  bool force = false;
  bool json = false;
};

void write_files(const TradeoffArguments& options, TradeoffReport& report) {
  if (options.folder.empty()) return;
  for (const fs::path& file : result_files(options.folder, "tradeoff"))
    report.output.push_back(file.string());
  write_result(options.folder, "tradeoff", json_text(to_json(report)));
}

ExitCode tradeoff(const TradeoffArguments& options) {
  // Wrong arguments are reported before anything is read.
  check(options);
  if (!options.folder.empty()) require_writable_folder(options.folder);
  if (!options.written_scene.empty())
    require_writable_scene(options.written_scene, options.scene.path, options.force);

  Scene scene = read(options.scene);
  opaque_soup(scene);
  TradeoffReport report = measure_tradeoff(options, scene);
  // What was measured is not lost with a scene that cannot be written.
  std::exception_ptr unwritten;
  if (!options.written_scene.empty()) try {
      write_chosen(options.written_scene, std::move(scene), report);
    } catch (const std::exception&) {
      unwritten = std::current_exception();
    }
  write_files(options, report);

  say_list("Reading:", report.notes);
  say(fmt::format("{} triangles, {} views of {} x {}, on {} ({})", counted(report.scene.triangles),
                  report.views, report.width, report.height, report.device.renderer,
                  report.device.context));
  say_tables(report);
  for (const std::string& path : report.output) say("wrote " + path);
  if (options.json) print_json(to_json(report));
  if (unwritten) std::rethrow_exception(unwritten);
  const bool lacks_choice = !options.written_scene.empty() && !report.scene_written;
  return lacks_choice ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

void add_tradeoff(Command& program, std::vector<std::string> arguments) {
  auto options = std::make_shared<TradeoffArguments>();
  options->arguments = std::move(arguments);
  Command command = program.add_command("tradeoff", "Error against run time, and the choice");
  command.footer(
      R"(Changes one quality setting at a time, then those that matter together, and measures for
each the time of a frame and the error against the oracle's image of the same model
(E_render). Antialiasing settings have an oracle of their own, with 8 x 8 samples a pixel. With
photographs the error against them (E_model) stands beside, never on one axis, and that of the
published pipeline with it. The choice is the cheapest with an E_render of at least 50 dB and
hardly a pixel covered wrongly.

Examples:
  tureen tradeoff soup.glb -o tradeoff                report.html and tradeoff.json
  tureen tradeoff soup.glb lego --scale 0.5 -o tradeoff
                                                      with E_model against photographs
  tureen tradeoff soup.glb --write fast.glb           the scene reduced as chosen, in a file of
                                                      its own
  tureen tradeoff soup.glb --full --json > soup.json  1280x720, all settings: long

Exit codes: 0 done, 1 nothing keeps to the limits and --write was given, 2 wrong usage,
3 the scene or the dataset cannot be read, 4 no OpenGL context, 5 it does not fit
on the device or cannot be written.)");
  add_scene_argument(command, options->scene);
  add_dataset_argument(command, options->dataset).required(false);
  add_memory_option(command);
  command.add_option("-o,--output", options->folder, "a folder for report.html and tradeoff.json")
      .value_name("FOLDER");
  add_choice<tradeoff::Samples>(
      command, "--reference", options->samples,
      {{"device", tradeoff::Samples::device}, {"exact", tradeoff::Samples::exact}},
      "what drawing settings are measured against: the oracle at the device's sample points "
      "(default), or of exact triangles, which adds what the device rounds")
      .value_name("NAME");
  const Option full = command.add_flag(
      "--full", [options] { options->effort = Effort::full; },
      "1280x720, 8 views and 4 adversarial ones, 5 rounds, 8 x 8 samples, all photographs; "
      "480x270, 4 views, 3 rounds, 4 x 4 samples and 8 photographs by default");
  command
      .add_flag(
          "--quick", [options] { options->effort = Effort::quick; },
          "96x64, 2 views, 1 round: whether it works at all")
      .excludes(full);
  command.add_option("--size", options->size, "image size in pixels").value_name("WxH");
  command
      .add_option("--cameras", options->cameras,
                  "the views, of one set or several: hemisphere:N, orbit:N, adversarial, dataset "
                  "(its test cameras), or a file of cameras; 4 of the scene's own by default, or "
                  "hemisphere:4 where it has none")
      .value_name("SET[,SET..]")
      .split_at_commas();
  command.add_option("--rounds", options->rounds, "rounds of all views")
      .check(between(1, 1000))
      .value_name("N");
  command
      .add_option("--combinations", options->combinations,
                  "limit of the combinations of the settings that matter, for drawing and for "
                  "antialiasing each, 48 by default; 0 changes one setting at a time")
      .check(between(0, 10000))
      .value_name("N");
  command
      .add_option("--photographs", options->photographs,
                  "limit of the dataset's test photographs, which are chosen evenly")
      .check(between(1, 1000000))
      .value_name("N");
  command
      .add_option("--least-psnr", options->limits.min_psnr_db,
                  "least E_render in dB of the choice, 50 by default")
      .check(between(0.0, 100.0))
      .value_name("DB");
  command
      .add_option("--most-mismatch", options->limits.max_coverage_mismatch,
                  "largest fraction of wrongly covered pixels of the choice, 1e-4 by default")
      .check(between(0.0, 1.0))
      .value_name("FRACTION");
  const Option write =
      command
          .add_option("--write", options->written_scene,
                      "the scene with its data reduced as chosen, as a GLB of ours; SCENE stays as "
                      "it is")
          .value_name("OUT.glb");
  command.add_flag("--force", options->force, "--write may replace a file").needs(write);
  command.add_flag(
      "--no-flip", [options] { options->with_flip = false; },
      "do not compute FLIP, which takes most of the time of comparing");
  command.add_flag("--processor-time", options->processor_time,
                   "processor time of all threads instead of time that passed: for ratios on a "
                   "busy machine; software OpenGL only");
  add_context_option(command, options->backend);
  command.add_flag("--json", options->json, "everything as JSON on standard output");
  command.does([options] { return tradeoff(*options); });
}

}  // namespace tureen::cli
