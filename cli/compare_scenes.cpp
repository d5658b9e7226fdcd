#include "cli/compare_scenes.hpp"

#include <fmt/format.h>

#include <array>

#include "base/output.hpp"
#include "cli/files/eval_images.hpp"
#include "cli/files/eval_result.hpp"
#include "cli/files/image_file.hpp"
#include "cli/files/result_files.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/options/values.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "image/heat_map.hpp"
#include "jobs/report/report_page.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct Measured {
  EvaluationOptions options;
  Evaluation result;
  std::vector<Image8> photographs, images;  // of the views; only for a report
};

Measured measure(const std::string& path, const SceneComparison& comparison,
                 std::span<const Photograph> photographs, const glm::vec3& background) {
  Scene scene = read(SceneArgument{.path = path});
  apply_opaque(scene, comparison.drawing);
  Measured measured;
  measured.options.backend = comparison.drawing.backend;
  measured.options.pipeline = comparison.drawing.pipeline;
  measured.options.plan = preferences_for(scene, comparison.drawing);
  measured.options.background = background;
  if (!comparison.folder.empty()) {
    measured.photographs.resize(photographs.size());
    measured.images.resize(photographs.size());
    // Each call has its own view, so the calls may come from several threads.
    measured.options.on_view = [&](std::size_t view, const ImageF& photograph,
                                   const ImageF& rendering) {
      measured.photographs[view] = quantised(photograph);
      measured.images[view] = quantised(rendering);
      for (glm::u8vec4& pixel : measured.images[view].pixels) pixel.a = 255;
    };
  }
  Progress progress("evaluating " + fs::path(path).filename().string());
  measured.options.progress = [&](double fraction) { progress.update(fraction); };
  measured.result = evaluate(scene, photographs, measured.options);
  measured.options.on_view = {};
  measured.options.progress = {};
  say_list("Reading " + path + ":", notes_of(scene.info));
  return measured;
}

/// Writes an image for each view: the photograph, both scenes, and their difference.
std::vector<std::string> write_pairs(const fs::path& folder, std::span<const Photograph> views,
                                     const Measured& a, const Measured& b) {
  make_folder(folder);
  std::vector<std::string> paths;
  const std::vector<std::string> names = image_names(views);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Image8 images[] = {a.photographs[i], a.images[i], b.images[i],
                             difference(to_float(a.images[i]), to_float(b.images[i]))};
    paths.push_back((folder / names[i]).string());
    write_image(side_by_side(images), paths.back());
  }
  return paths;
}

void say_table(const SceneComparison& comparison, const Evaluation& a, const Evaluation& b) {
  Table table(
      {"view", "PSNR dB: A", "B", "B - A", "SSIM: A", "B", "B - A", "FLIP: A", "B", "B - A"});
  const auto add_row = [&](const std::string& name, const ViewMetrics& x, const ViewMetrics& y) {
    table.row({name, fmt::format("{:.2f}", x.psnr_db), fmt::format("{:.2f}", y.psnr_db),
               fmt::format("{:+.2f}", y.psnr_db - x.psnr_db), fmt::format("{:.4f}", x.ssim),
               fmt::format("{:.4f}", y.ssim), fmt::format("{:+.4f}", y.ssim - x.ssim),
               fmt::format("{:.4f}", x.flip), fmt::format("{:.4f}", y.flip),
               fmt::format("{:+.4f}", y.flip - x.flip)});
  };
  for (std::size_t i = 0; i < a.views.size(); ++i) add_row(a.views[i].name, a.views[i], b.views[i]);
  add_row("mean", a.mean, b.mean);
  say("A: " + comparison.a + ", B: " + comparison.b);
  for (const std::string& line : table.lines()) say(line);
}

}  // namespace

void add_scene_comparison(Command& command, SceneComparison& comparison) {
  add_dataset_argument(command, comparison.dataset).required(false);
  add_split_option(command, comparison.split);
  command.add_option("-o,--output FOLDER", comparison.folder,
                     "with DATASET: folder for report.html, compare.json, and an image per view: "
                     "photograph, A, B, and the difference between A and B side by side");
  add_drawing_options(command, comparison.drawing);
}

ExitCode compare_scenes(const SceneComparison& comparison) {
  const std::string& folder = comparison.folder;
  std::vector<fs::path> files;
  if (!folder.empty()) {
    files = result_files(folder, "compare");
    require_writable_folder(folder);
    std::error_code unknown;
    if (fs::is_directory(comparison.dataset.path, unknown))
      require_not_input(fs::path(folder) / "report.html", comparison.dataset.path);
    for (const fs::path& file : files)
      for (const std::string& input : {comparison.a, comparison.b}) require_not_input(file, input);
  }
  const glm::vec3 background = comparison.background.empty()
                                   ? read(SceneArgument{.path = comparison.a}).info.background
                                   : glm::vec3(parse_background(comparison.background));
  Dataset dataset = read(comparison.dataset, comparison.split);
  require_sides(comparison.dataset, dataset, {.least = ssim_window});
  const EvaluationOptions none;
  const std::vector<Photograph> photographs =
      photographs_of(dataset, {comparison.a, comparison.dataset, comparison.split, none});
  Measured a = measure(comparison.a, comparison, photographs, background);
  Measured b = measure(comparison.b, comparison, photographs, background);

  const EvalSubject of_a{comparison.a, comparison.dataset, comparison.split, a.options};
  const EvalSubject of_b{comparison.b, comparison.dataset, comparison.split, b.options};
  say_list("Reading " + comparison.dataset.path + ":", notes_of(dataset.remarks));
  say(describe(of_a, photographs) + ", on " + a.result.renderer);
  const Quality& quality = b.options.plan.quality;
  if (quality != a.options.plan.quality)
    say("B stores another quality setting: " + describe(quality));
  say_table(comparison, a.result, b.result);
  Json json{{"a", to_json(of_a, a.result, {})}, {"b", to_json(of_b, b.result, {})}};
  if (!folder.empty()) {
    json["a"]["pairs"] = write_pairs(folder, photographs, a, b);
    say("Each image in " + folder + " shows, from left to right: the photograph, A (" +
        comparison.a + "), B (" + comparison.b + "), their difference");
    const std::array<results::ReportResult, 2> sides{
        results::ReportResult{files[0].string(), "eval", json["a"].dump()},
        results::ReportResult{files[0].string(), "eval", json["b"].dump()}};
    write_file(files[0], json_text(json));
    write_file(files[1], results::report_page(sides, files[1]));
    say(fmt::format("wrote {} images to {}", photographs.size(), folder));
    for (const fs::path& file : files) say("wrote " + file.string());
  }
  if (comparison.json) print_json(json);
  return ExitCode::done;
}

}  // namespace tureen::cli
