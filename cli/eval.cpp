// `tureen eval`: image metrics of a scene against the photographs of a dataset.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "cli/files/eval_images.hpp"
#include "cli/files/eval_result.hpp"
#include "cli/files/result_files.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/arguments.hpp"
#include "cli/options/dataset_argument.hpp"
#include "cli/options/drawing_options.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/renderer_option.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/options/values.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "jobs/eval/evaluation.hpp"

namespace tureen::cli {

namespace {

struct EvalOptions {
  SceneArgument scene;
  DatasetArgument dataset;
  DrawingOptions drawing;
  RendererChoice renderer;
  EvaluationOptions evaluation;
  DatasetPart split = DatasetPart::test;
  std::string background;  // empty: the scene's own
  std::string folder;
  bool verbose = false;
  bool json = false;
};

ExitCode evaluate_scene(EvalOptions options) {
  // Wrong arguments are reported before anything is read.
  EvaluationOptions& evaluation = options.evaluation;
  if (options.background == "transparent")
    throw UsageError(
        "eval does not support --background transparent; use white, black or 0.2,0.4,1");
  if (!options.background.empty())
    evaluation.background = glm::vec3(parse_background(options.background));
  if (!options.folder.empty()) require_writable_folder(options.folder);
  const std::filesystem::path data = options.dataset.path;
  std::error_code unknown;  // reading reports missing paths
  const std::filesystem::path spared =
      std::filesystem::is_directory(data, unknown) ? data : data.parent_path();
  if (!options.folder.empty())
    for (const std::filesystem::path& file : result_files(options.folder, "eval")) {
      require_not_input(file, spared);
      require_not_input(file, options.scene.path);
    }

  Scene scene = read(options.scene);
  apply_opaque(scene, options.drawing);
  if (options.background.empty()) evaluation.background = scene.info.background;
  evaluation.pipeline = options.drawing.pipeline;
  evaluation.plan = preferences_for(scene, options.drawing);
  evaluation.backend = options.drawing.backend;
  Dataset dataset = read(options.dataset, options.split);
  require_sides(options.dataset, dataset, {.least = ssim_window});
  const EvalSubject subject{options.scene.path, options.dataset, options.split, evaluation};
  const std::vector<Photograph> photographs = photographs_of(dataset, subject);

  std::optional<EvalImages> images;
  if (!options.folder.empty()) {
    images.emplace(options.folder, spared, photographs);
    evaluation.on_view = [&](std::size_t view, const ImageF& photograph, const ImageF& rendering) {
      images->write(view, photograph, rendering);
    };
  }
  Evaluation result;
  {
    Progress progress("evaluating");
    evaluation.progress = [&](double fraction) { progress.update(fraction); };
    if (const ProcessorRenderer* renderer = options.renderer.renderer) {
      const auto source = renderer->make(scene, {.quality = evaluation.plan.quality,
                                                 .background = evaluation.background,
                                                 .progress = [](double) { throw_if_interrupted(); },
                                                 .samples = options.renderer.samples});
      result = evaluate(*source, photographs, evaluation);
      result.renderer = renderer->name;
      result.context = "processor";
    } else {
      result = evaluate(scene, photographs, evaluation);
    }
  }
  std::vector<std::string> output;
  if (images) output = images->finish();
  say_list("Reading " + options.scene.path + ":", notes_of(scene.info));
  say_what_is_hidden(scene);
  say_list("Reading " + options.dataset.path + ":", notes_of(dataset.remarks));
  if (options.verbose) say_list("Plan:", result.plan);
  say(fmt::format("{} against {}, on {} ({})",
                  primitives_text(triangle_count(scene), splat_count(scene)),
                  describe(subject, photographs), result.renderer, result.context));
  Table table(
      {"view", "PSNR dB", "SSIM", evaluation.metrics.with_flip ? "FLIP" : "", "holes", "specks"});
  const auto add_row = [&](const std::string& name, const ViewMetrics& view) {
    table.row({name, fmt::format("{:.2f}", view.psnr_db), fmt::format("{:.4f}", view.ssim),
               evaluation.metrics.with_flip ? fmt::format("{:.4f}", view.flip) : "",
               fmt::format("{:.1e}", view.holes), fmt::format("{:.1e}", view.specks)});
  };
  for (const ViewMetrics& view : result.views) add_row(view.name, view);
  add_row("mean", result.mean);
  for (const std::string& line : table.lines()) say(line);
  if (!options.folder.empty()) {
    say(fmt::format("wrote {} images to {}", output.size(), options.folder));
    const std::vector<std::filesystem::path> files = result_files(options.folder, "eval");
    for (const std::filesystem::path& file : files) output.push_back(file.string());
    write_result(options.folder, "eval", json_text(to_json(subject, result, output)));
    for (const std::filesystem::path& file : files) say("wrote " + file.string());
  }
  if (options.json) print_json(to_json(subject, result, output));
  return ExitCode::done;
}

}  // namespace

void add_eval(Command& program) {
  auto options = std::make_shared<EvalOptions>();
  Command command = program.add_command("eval", "Compare a scene with photographs");
  command.footer(
      R"(Draws the scene from the cameras of the photographs. Prints PSNR, SSIM and FLIP for each
view, and their means. Photographs with alpha are drawn over the background.
Holes: mean of 1 - alpha where the photograph is opaque. Specks: fraction of pixels that differ from
the median of their 5x5 neighbours by more than 0.15, where the photograph differs by less than 0.05.

Examples:
  tureen eval soup.glb lego
  tureen eval soup.glb fox --scale 0.25 --split all
  tureen eval soup.glb lego --supersample 4     with 4x4 samples per pixel
  tureen eval soup.glb lego -o views            images with heat maps, and a report
  tureen eval soup.glb lego --json              the metrics for scripts
  tureen eval splats.ply fox                    splats, blended as in their method
  tureen eval splats.ply fox --renderer trace   the same in exact order along each ray
  tureen eval soup.glb lego --ssim-border uniform7    SSIM as in DiffSoup on synthetic
                                                      scenes

Exit codes: 0 done, 2 wrong usage, 3 the scene or the dataset cannot be read, 4 no OpenGL
context, 5 the scene does not fit on the device, or the output cannot be written.)");
  add_scene_argument(command, options->scene);
  add_dataset_argument(command, options->dataset);
  add_memory_option(command);
  add_split_option(command, options->split);
  command.add_option(
      "-o,--output FOLDER", options->folder,
      "folder for report.html, eval.json, contact_sheet.png, and an image per view: photograph, "
      "rendering, heat map, and holes and specks (magenta and yellow) side by side");
  command.add_option("--background COLOR", options->background,
                     "colour behind the scene and behind photographs with alpha: a name, "
                     "#rrggbb, or r,g,b from 0 to 1; the scene's own by default");
  add_eval_border(command, options->evaluation.metrics);
  command.add_flag(
      "--no-flip", [options] { options->evaluation.metrics.with_flip = false; },
      "do not compute FLIP; saves more than half of the time for the metrics");
  add_drawing_options(command, options->drawing);
  command.add_flag("--verbose", options->verbose, "also print the plan");
  command.add_flag("--json", options->json, "print the metrics as JSON to standard output");
  const auto check_renderer = add_renderer_option(command, options->renderer, "--scale");
  command.does([options, check_renderer] {
    check_renderer();
    return evaluate_scene(*options);
  });
}

}  // namespace tureen::cli
