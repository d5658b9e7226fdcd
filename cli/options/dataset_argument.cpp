#include "cli/options/dataset_argument.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "cli/progress.hpp"

namespace tureen::cli {

namespace {

/// Accepts numbers in (0, 1]; between() would include 0. Above 1, many mean the scene's size.
std::string refuse_scale(const std::string& text, bool has_resize) {
  const auto scale = number_from(text);
  if (scale && *scale > 0 && *scale <= 1) return {};
  return "a scale of photographs must be above 0 and at most 1, not " + text +
         (scale && *scale > 1 && has_resize ? "; --resize " + text + " enlarges the scene" : "");
}

}  // namespace

Option add_scale_option(Command& command, DatasetArgument& argument) {
  const bool has_resize = command.has_option("--resize");
  return command.add_option(
      "--scale FRACTION", argument.options.scale,
      "scale of the photographs, above 0 and at most 1 (default): 0.5 halves "
      "both sides, and each pixel is the mean of the pixels it covers",
      [has_resize](const std::string& text) { return refuse_scale(text, has_resize); });
}

Option add_dataset_argument(Command& command, DatasetArgument& argument) {
  const Option dataset =
      command
          .add_option("DATASET", argument.path,
                      "posed photographs: a folder with one of these: transforms.json; "
                      "transforms_train.json and transforms_test.json; a COLMAP model and "
                      "images; bundle.out and list.txt (docs/datasets.md)")
          .required();
  add_scale_option(command, argument);
  command.add_option(
      "--images N", argument.options.images_folder,
      "read photographs from the folder images_N, where some datasets have copies N times smaller",
      between(1, 64));
  command.add_option("--test-every N", argument.options.test_every,
                     "use every N-th photograph in name order as a test view, starting with the "
                     "first, if the dataset has no split; 8 by default",
                     between(2, 1000000));
  add_choice<std::optional<AlphaMeaning>>(
      command, "--alpha MEANING", argument.options.alpha,
      {{"background", AlphaMeaning::background},
       {"mask", AlphaMeaning::mask},
       {"ignore", AlphaMeaning::ignore}},
      "meaning of transparent pixels in photographs: background (around an object), mask (not "
      "used) or ignore (opaque); by default chosen from all photographs (docs/datasets.md)");
  command.add_flag(
      "--strict", argument.options.is_strict,
      "reject a dataset if any photograph cannot be used; by default such photographs are skipped");
  return dataset;
}

void require_sides(const DatasetArgument& argument, const Dataset& dataset, SideLimits limits) {
  for (const auto* views : {&dataset.train, &dataset.test})
    for (const Photograph& view : *views) {
      const auto [shorter, longer] = std::minmax(view.camera.width, view.camera.height);
      if (shorter >= limits.least && longer <= limits.most) continue;
      const std::string bound = shorter < limits.least ? fmt::format("at least {}", limits.least)
                                                       : fmt::format("at most {}", limits.most);
      throw InputError({argument.path},
                       fmt::format("{} is {} x {} pixels; each side must have {}", view.camera.name,
                                   view.camera.width, view.camera.height, bound),
                       longer > limits.most ? "--scale makes it smaller" : "");
    }
}

Dataset read(const DatasetArgument& argument, DatasetPart part) {
  const std::filesystem::path path = argument.path;
  const std::filesystem::path name = path.has_filename() ? path : path.parent_path();
  Progress progress("reading photographs of " + name.filename().string());
  DatasetOptions options = argument.options;
  options.part = part;
  options.progress = [&](double fraction) { progress.update(fraction); };
  return read_dataset(path, options);
}

}  // namespace tureen::cli
