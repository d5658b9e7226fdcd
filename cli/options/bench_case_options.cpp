#include "cli/options/bench_case_options.hpp"

#include <algorithm>
#include <span>

#include "base/error.hpp"
#include "base/suggestion.hpp"
#include "jobs/bench/bench_cases.hpp"

namespace tureen::cli {

void add_case_options(Command& command, BenchCaseArguments& options) {
  add_drawing_options(command, options.drawing);
  add_drawing_scale(command, options.drawing);
  command
      .add_option(
          "--only NAME,..", options.only,
          "cases to measure, separated by commas: tureen (the plan), tureen-fragment and "
          "tureen-compute (triangles: the plan with --shading), raster and tiles (splats: the plan "
          "with --blend), generic (no specialisation), baseline, triangles and copy (upper limits "
          "of the speed, see --ceilings); ratios are relative to the first case")
      .split_at_commas()
      .single_argument();
  command.add_flag("--ceilings", options.ceilings,
                   "also measure two upper limits of the speed: drawing the triangles with an "
                   "empty fragment shader, and copying the same number of pixels");
}

void check(const BenchCaseArguments& options) {
  const std::span<const std::string> all_names = bench_case_names();
  for (std::size_t i = 0; i < options.only.size(); ++i) {
    const std::string& name = options.only[i];
    if (std::find(all_names.begin(), all_names.end(), name) == all_names.end())
      throw UsageError(
          "--only takes tureen, tureen-fragment, tureen-compute, raster, tiles, generic, baseline, "
          "triangles and copy, not '" +
              name + "'",
          did_you_mean(name, all_names));
    if (std::find(options.only.begin(), options.only.begin() + std::ptrdiff_t(i), name) !=
        options.only.begin() + std::ptrdiff_t(i))
      throw UsageError("--only names " + name + " twice");
  }
  // Two names for one case.
  if (std::count(options.only.begin(), options.only.end(), "baseline") > 0 &&
      std::count(options.only.begin(), options.only.end(), "published") > 0)
    throw UsageError("--only names the baseline twice: as baseline and as published");
}

}  // namespace tureen::cli
