// `tureen-view`: the window. `tureen view` starts it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/memory_budget.hpp"
#include "base/memory_help.hpp"
#include "base/shown_text.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/scene_file.hpp"
#include "viewer/application.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

// The exit codes of all programs here (ARCHITECTURE.md).
enum class ExitCode { done = 0, failed = 1, usage = 2, bad_input = 3, no_context = 4, other = 5 };

ExitCode code_of(const std::exception& error) {
  if (dynamic_cast<const UsageError*>(&error)) return ExitCode::usage;
  if (dynamic_cast<const InputError*>(&error)) return ExitCode::bad_input;
  if (dynamic_cast<const ContextError*>(&error)) return ExitCode::no_context;
  return ExitCode::other;
}

/// Ctrl-C in the terminal closes the window, so that settings are kept.
volatile std::sig_atomic_t was_interrupted = 0;
extern "C" void note_interrupt(int) { was_interrupted = 1; }

struct Arguments {
  ApplicationOptions options;  // those with a value of their own
  std::vector<std::string> paths;
  std::string api = "gl", size, replay, pipeline = "auto", profile, blend = "auto";
  bool no_settings = false, report = false;
};

void add_arguments(CLI::App& program, Arguments& arguments) {
  ApplicationOptions& options = arguments.options;
  program
      .add_option("SCENE", arguments.paths,
                  "scenes: files or folders in any format that tureen info reads; several are "
                  "drawn together, each as a layer. One argument after the first scene can be a "
                  "DATASET for comparison: a .json file, or a folder that is not a scene, with "
                  "photographs (COLMAP, NeRF or Bundler)")
      ->option_text(".. [DATASET]");
  program.add_option("--size", arguments.size, "window size in screen coordinates")
      ->option_text("WxH");
  program
      .add_option("--api", arguments.api,
                  "graphics API: gl (default, OpenGL 3.3) or es (OpenGL ES 3.0)")
      ->check(CLI::IsMember({"gl", "es"}))
      ->option_text("NAME");
  program
      .add_option(
          "--pipeline", arguments.pipeline,
          "pipeline: auto (default, Tureen's own) or baseline (soups as in DiffSoup's viewer, "
          "splats as instanced quads)")
      ->check(CLI::IsMember({"auto", "baseline", "published"}))
      ->option_text("NAME");
  program
      .add_option("--training", options.training,
                  "log of a tureen train run to watch and control; SCENE is its OUT.watch.glb")
      ->option_text("OUT.jsonl");
  program
      .add_option("--blend", arguments.blend,
                  "blending of splats: raster (on the GPU), tiles (on the CPU), or auto (default: "
                  "tiles on software OpenGL, but not with --as-published)")
      ->check(CLI::IsMember(
          std::vector<std::string>(splat_blending_names.begin(), splat_blending_names.end())))
      ->option_text("NAME");
  program.add_flag_callback(
      "--no-specialise", [&options] { options.drawing.plan.specialise = false; },
      "apply no specialisation: also draw and compute the parts that the scene does "
      "not need");
  program.add_flag_callback(
      "--no-smooth-at-rest", [&options] { options.smooth_at_rest = false; },
      "draw still views and saved images with one sample per pixel: switches off \"Smooth at "
      "rest\" in the panel Drawing");
  program.add_flag("--trace", options.trace,
                   "ray-trace still views and saved images: mirrors, glass, splats in exact order "
                   "per pixel (\"Trace\" in the panel Drawing)");
  std::vector<std::string> profiles;
  for (const NamedProfile& each : named_profiles) profiles.emplace_back(each.name);
  program
      .add_option("--profile", arguments.profile,
                  "draw splats by the rules of another method; the scene's own by default")
      ->check(CLI::IsMember(profiles))
      ->option_text("NAME");
  program.add_flag(
      "--as-published", options.drawing.plan.as_published,
      "also apply the culling rules in the authors' code that depend on the resolution");
  program
      .add_option("--images,--pictures", options.images,
                  "folder for saved images; created if it does not exist")
      ->option_text("FOLDER");
  program
      .add_option_function<std::string>(
          "--max-memory", [](const std::string& text) { set_max_memory(parse_memory_size(text)); },
          max_memory_help)
      ->option_text("SIZE");
  program
      .add_option(
          "--max-splats", options.max_splats,
          "read at most N splats from each scene, those with the largest opacity times area")
      ->check(CLI::Range(std::uint64_t(1), std::uint64_t(0xffffffff)))
      ->option_text("N");
  program
      .add_option("--lod", options.lod,
                  "level of detail to read from a streamed scene; 0 is the finest. By default, "
                  "the finest that fits")
      ->check(CLI::Range(0, 63))
      ->option_text("N");
  program.add_flag("--no-settings", arguments.no_settings, "do not load or save settings");
  program.add_flag(
      "--report", arguments.report,
      "at the end, print the time to the first image, the main thread's longest frame while a "
      "scene was loading (drawing excluded), and how often the scene was drawn");
  program.add_option("--record", options.record, "session file to write: the events of this run")
      ->option_text("FILE");
  program
      .add_option("--replay", arguments.replay,
                  "session file to replay; the window then exits, with code 1 if it shows an error")
      ->option_text("FILE");
}

std::optional<glm::ivec2> parse_size(const std::string& text) {
  if (text.empty()) return std::nullopt;
  glm::ivec2 size(0);
  int end = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%n", &size.x, &size.y, &end) != 2 ||
      std::size_t(end) != text.size() || size.x < 1 || size.y < 1)
    throw UsageError("--size needs a width and a height", "write it as 1280x800");
  return size;
}

void take_paths(const std::vector<std::string>& paths, ApplicationOptions& options) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    // The first path opens as whatever it is; a later one may be a dataset to compare with.
    if (i == 0 || !is_dataset(paths[i]) || is_scene(paths[i])) {
      options.scenes.emplace_back(paths[i]);
      continue;
    }
    if (!options.dataset.empty())
      throw UsageError("two datasets: " + options.dataset.string() + " and " + paths[i] +
                       "; the window compares with one");
    options.dataset = paths[i];
  }
}

int run(Arguments& arguments) {
  ApplicationOptions& options = arguments.options;
  take_paths(arguments.paths, options);
  options.api = arguments.api == "es" ? gl::Api::es : gl::Api::desktop;
  options.window = parse_size(arguments.size);
  if (arguments.pipeline != "auto") options.drawing.pipeline = PipelineKind::baseline;
  options.drawing.plan.splat_blending = SplatBlending(
      std::find(splat_blending_names.begin(), splat_blending_names.end(), arguments.blend) -
      splat_blending_names.begin());
  options.drawing.plan.splat_profile = profile_named(arguments.profile);
  if (!arguments.replay.empty()) options.replay = read_session(arguments.replay);
  // A session must not depend on stored settings.
  if (!arguments.no_settings && arguments.replay.empty()) options.settings = settings_file();
  options.interrupted = [] { return was_interrupted != 0; };
  Application application(std::move(options));
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
  application.run();
  if (arguments.report)
    std::fprintf(
        stderr,
        "first image after %.2f s; longest frame while loading %.1f ms, drawing excluded; drawn %d "
        "times\n",
        application.report().first_image_seconds, application.report().longest_busy_ms,
        application.report().drawn);
  if (arguments.replay.empty()) return int(ExitCode::done);
  const std::vector<std::string> errors = application.errors();
  for (const std::string& error : errors)
    std::fprintf(stderr, "tureen-view: %s\n", shown_line(error).c_str());
  return int(errors.empty() ? ExitCode::done : ExitCode::failed);
}

}  // namespace

}  // namespace tureen::viewer

// NOLINTNEXTLINE(bugprone-exception-escape): without memory there is no message
int main(int argc, char** argv) {
  using namespace tureen::viewer;
  CLI::App program("Shows triangle soups and splats in a window.", "tureen view");
  program.footer(
      R"(Without SCENE, the window offers the example and recent scenes. F1 lists the keys.

Examples:
  tureen view soup.glb
  tureen view soup.glb photographs/          the keys [ and ] select the photographs' cameras
  tureen view room.glb chair.glb             both, as layers of one scene
  tureen view out.watch.glb --training out.jsonl    a run of tureen train --watch

Exit codes: 0 done, 1 the window showed an error at the end of a replay, 2 wrong usage, 3 the
session or the settings cannot be read, 4 no display or no OpenGL, 5 any other error.)");
  Arguments arguments;
  add_arguments(program, arguments);
  try {
    program.parse(argc, argv);
    return run(arguments);
  } catch (const CLI::Success& help) {
    program.exit(help);
    if (std::cout.flush()) return int(ExitCode::done);
    std::fprintf(stderr, "tureen view: standard output cannot be written\n");
    return int(ExitCode::other);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "tureen view: %s\nTry: tureen view --help\n",
                 tureen::shown_line(error.what()).c_str());
    return int(ExitCode::usage);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tureen view: %s\n", tureen::shown_line(error.what()).c_str());
    return int(code_of(error));
  }
}
