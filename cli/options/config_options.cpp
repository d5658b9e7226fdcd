#include "cli/options/config_options.hpp"

#include <charconv>

namespace tureen::cli {

using trainer::Preset;

namespace {

template <class T>
Option add_number(Command& command, const std::string& name, std::optional<T>& value,
                  const std::string& help) {
  return command.add_option(name, value, help).value_name("N");
}

/// Negative numbers and numbers beyond 64 bits would wrap around to other seeds.
std::string refuse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && stop == end) return {};
  return "a seed must be a whole number from 0 to 18446744073709551615, not " + text;
}

}  // namespace

void add_config_options(Command& command, TrainingOptions& options) {
  add_choice<TrainingMethodName>(
      command, "--method", options.method,
      {{"diffsoup", TrainingMethodName::diffsoup},
       {"gaussians", TrainingMethodName::gaussians},
       {"triangles", TrainingMethodName::triangles}},
      "diffsoup (default): opaque triangles with textures; gaussians: 3D Gaussian Splatting, on "
      "the processor; triangles: Triangle Splatting, on the processor")
      .value_name("NAME");
  add_choice<std::optional<Preset>>(
      command, "--preset", options.preset, {{"object", Preset::object}, {"scene", Preset::scene}},
      "constants for the kind of dataset: object (default if the images have alpha, or borders of "
      "one colour) or scene (default otherwise)")
      .value_name("NAME");
  command.add_option("--config", options.file, "JSON file with constants; --list-config lists them")
      .value_name("FILE");
  command.add_flag("--compat", options.published,
                   "use the constants of published DiffSoup where Tureen's differ");
  add_number(command, "--triangles", options.triangles,
             "number of triangles at the end; 15,000 by default");
  add_number(command, "--max-splats", options.max_splats,
             "largest number of Gaussians or soft triangles; 60,000 by default");
  add_number(command, "--steps", options.steps,
             "number of optimiser steps; by default 10,000, for gaussians and triangles 5,000; "
             "replaces the minutes of --config");
  add_number(command, "--minutes", options.minutes,
             "time for the training of gaussians or triangles, more than 0; the number of steps is "
             "fitted to it and replaces the steps of --config");
  command.add_flag("--flat", options.flat,
                   "discs (2D Gaussian Splatting) instead of Gaussians with three scales");
  command.add_flag("--opaque", options.opaque,
                   "triangles become opaque at the end; the result is a triangle soup");
  add_number(command, "--batch", options.batch, "views per step; 4 by default");
  add_number(command, "--seed", options.seed, "seed of the random numbers; 0 by default")
      .check(refuse_seed);
  add_number(
      command, "--level", options.level,
      "finest lattice level: a face has (2^N + 1)(2^N + 2) / 2 texels; by default 3 to 5: the "
      "more pixels a triangle covers, the finer");
  command
      .add_option("--init", options.begin,
                  "first primitives: random, points (structure-from-motion points of the dataset), "
                  "or a scene to continue from; by default points if the dataset has them, else "
                  "random (for soups: Gaussians, which are trained first)")
      .value_name("WHERE");
}

}  // namespace tureen::cli
