// `tureen compare`: metrics of the difference between two images, and of two scenes against the
// same photographs.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "cli/commands.hpp"
#include "cli/compare_scenes.hpp"
#include "cli/files/image_file.hpp"
#include "cli/options/arguments.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/values.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "formats/scene_file.hpp"
#include "image/heat_map.hpp"
#include "image/metrics.hpp"

namespace tureen::cli {

namespace {

/// A metric with its name and direction.
struct NamedMetric {
  const char* key;  // in JSON and for --metric
  double Metrics::*value;
  bool lower_is_worse;
  const char* meaning;
};

constexpr std::array named_metrics{
    NamedMetric{"mae", &Metrics::mae, false, "mean absolute difference"},
    NamedMetric{"mse", &Metrics::mse, false, "mean squared difference"},
    NamedMetric{"psnr_db", &Metrics::psnr_db, true,
                "peak signal-to-noise ratio, 100 for equal images"},
    NamedMetric{"ssim", &Metrics::ssim, true, "structural similarity, 1 for equal images"},
    NamedMetric{"flip", &Metrics::flip, false, "perceived difference, 67 pixels per degree"},
    NamedMetric{"max_abs", &Metrics::max_abs, false, "largest difference in a channel"},
    NamedMetric{"p999_abs", &Metrics::p999_abs, false,
                "99.9th percentile of the differences in a channel"},
    NamedMetric{"coverage_mismatch", &Metrics::coverage_mismatch, false,
                "fraction of pixels covered in one image only (alpha >= 1/2)"},
    NamedMetric{"failing_fraction", &Metrics::failing_fraction, false,
                "fraction of pixels with a difference above --pixel-tolerance"},
};

struct CompareOptions {
  std::string a, b, diff, background;  // empty: black
  SceneComparison scenes;
  const NamedMetric* metric = &named_metrics.front();  // that --tolerance limits
  std::optional<double> tolerance;
  MetricOptions metrics;
  bool json = false;
};

Json json_of(const CompareOptions& options, const Metrics& metrics, std::optional<bool> passed) {
  Json json;
  for (const NamedMetric& metric : named_metrics) json[metric.key] = metrics.*metric.value;
  json["ssim_border"] = name(options.metrics.ssim_border);
  json["non_finite"] = metrics.non_finite;
  if (passed) {
    json["metric"] = options.metric->key;
    json["tolerance"] = *options.tolerance;
    json["passed"] = *passed;
  }
  return json;
}

/// Whether the path is a scene and no image.
bool is_scene_file(const std::string& path) {
  try {
    return extension_of(path) != ".png" && is_scene(path);
  } catch (const InputError&) {
    return false;  // reading it as an image reports the reason
  }
}

ExitCode compare_images(const CompareOptions& options) {
  for (const std::string& path : {options.a, options.b})
    if (is_scene_file(path))
      throw UsageError(path + " is a scene; two scenes are compared on photographs",
                       "tureen compare A.glb B.glb DATASET");
  if (!options.scenes.folder.empty())
    throw UsageError("-o needs DATASET", "--diff writes an image");
  if (!options.diff.empty()) {
    require_png_name(options.diff);
    for (const std::string& input : {options.a, options.b}) require_not_input(options.diff, input);
    require_writable_file(options.diff);
  }
  const glm::vec3 background(
      parse_background(options.background.empty() ? "black" : options.background));
  const ImageF a = composited(to_float(read_image(options.a)), background);
  const ImageF b = composited(to_float(read_image(options.b)), background);
  const Metrics metrics = compare(a, b, options.metrics);

  std::optional<bool> passed;
  const NamedMetric& metric = *options.metric;
  const double value = metrics.*metric.value;
  if (options.tolerance)
    passed = metric.lower_is_worse ? value >= *options.tolerance : value <= *options.tolerance;

  if (!options.diff.empty()) write_image(side_by_side(a, b), options.diff);
  if (options.json) {
    print_json(json_of(options, metrics, passed));
  } else {
    Table table({"", "", "<"});
    for (const NamedMetric& m : named_metrics)
      table.row({m.key, fmt::format("{:.6g}", metrics.*m.value), m.meaning});
    for (const std::string& line : table.lines()) say(line);
  }
  if (passed == false)
    say(fmt::format("tureen: the images differ: {} is {:.6g}, the tolerance is {:.6g}", metric.key,
                    value, *options.tolerance));
  return passed == false ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

void add_compare(Command& program) {
  auto options = std::make_shared<CompareOptions>();
  Command command =
      program.add_command("compare", "Compare two images, or two scenes on photographs");
  command.footer(
      R"(Images with alpha are drawn over --background before the comparison. With DATASET, A and B are
scenes: both are drawn from the cameras of the photographs, with PSNR, SSIM and FLIP for each view.

Examples:
  tureen compare ours.png theirs.png
  tureen compare ours.png theirs.png --tolerance 0.002             exit with 1 if the mean
                                                                   difference is larger
  tureen compare ours.png theirs.png --metric psnr_db --tolerance 45
                                                                   exit with 1 below 45 dB
  tureen compare soup.glb splats.glb lego -o report                two scenes, view by view
  tureen compare ours.png theirs.png --diff where.png              with a heat map

Exit codes: 0 done, 1 worse than --tolerance, 2 wrong usage, 3 an input cannot be read,
4 no OpenGL context for scenes.)");
  command.add_option("A", options->a, "first image, PNG or JPEG, or scene").required();
  command.add_option("B", options->b, "second image, of the same size, or scene").required();
  add_scene_comparison(command, options->scenes);
  command.add_flag("--json", options->json, "print the metrics as JSON to standard output");
  command.add_option("--tolerance VALUE", options->tolerance,
                     "limit for --metric; exit with 1 if the metric is worse",
                     [](const std::string& text) {
                       // With a negative, infinite or NaN tolerance every comparison would have the
                       // same result.
                       const std::optional<double> value = number_from(text);
                       return text.starts_with('-') || !value || !std::isfinite(*value)
                                  ? "a tolerance must be a number of at least 0, not " + text
                                  : std::string();
                     });
  std::vector<std::pair<std::string, const NamedMetric*>> metrics;
  for (const NamedMetric& metric : named_metrics) metrics.emplace_back(metric.key, &metric);
  add_choice<const NamedMetric*>(
      command, "--metric NAME", options->metric, metrics,
      "metric for --tolerance: a name in the printed table; mae by default");
  command.add_option(
      "--pixel-tolerance VALUE", options->metrics.pixel_tolerance,
      "difference of a channel, 0 to 1, above which a pixel counts as different; 1/255 by default",
      between(0.0, 1.0));
  std::vector<std::pair<std::string, SsimBorder>> borders;
  for (const SsimBorder border : {SsimBorder::zero_pad, SsimBorder::valid, SsimBorder::uniform7})
    borders.emplace_back(name(border), border);
  add_choice<SsimBorder>(command, "--ssim-border MODE", options->metrics.ssim_border, borders,
                         "SSIM window at the image border: zero_pad (default, as in 3DGS), valid, "
                         "or uniform7 (scikit-image)");
  command.add_option("--background COLOR", options->background,
                     "colour behind transparent pixels: a name, #rrggbb, or r,g,b from 0 to 1; by "
                     "default black for images, scene A's own for scenes");
  command.add_option("--diff OUT.png", options->diff,
                     "image to write: A, B and a heat map of their differences, side by side");
  add_memory_option(command);
  command.does([options, command] {
    SceneComparison& scenes = options->scenes;
    if (scenes.dataset.path.empty()) return compare_images(*options);
    for (const char* name :
         {"--tolerance", "--metric", "--pixel-tolerance", "--ssim-border", "--diff"})
      if (command.option(name).is_given())
        throw UsageError(std::string(name) + " is for two images, without DATASET");
    scenes.a = options->a;
    scenes.b = options->b;
    scenes.background = options->background;
    scenes.json = options->json;
    return compare_scenes(scenes);
  });
}

}  // namespace tureen::cli
