#include "cli/options/config_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "trainer/diffsoup/config_fields.hpp"
#include "trainer/diffsoup/config_file.hpp"

namespace tureen::cli {

using trainer::Config;
using trainer::Initialisation;
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

/// The value of the constant `name`. A value beyond int is also beyond every range.
int as_int(std::int64_t value, std::string_view name) {
  if (std::in_range<int>(value)) return static_cast<int>(value);
  const auto fields = trainer::config_fields();
  const auto field = std::find_if(fields.begin(), fields.end(),
                                  [&](const auto& candidate) { return candidate.name == name; });
  throw UsageError(std::string(name) + ": " +
                   field->range.refusal(double(value), std::to_string(value)));
}

}  // namespace

std::string ConfigOptions::mesh() const {
  return begin == "random" || begin == "points" ? std::string() : begin;
}

void add_config_options(Command& command, ConfigOptions& options) {
  add_choice<std::optional<Preset>>(
      command, "--preset", options.preset, {{"object", Preset::object}, {"scene", Preset::scene}},
      "constants for the kind of dataset: object (default if the images have alpha) or scene "
      "(default otherwise)")
      .value_name("NAME");
  command.add_option("--config", options.file, "JSON file with constants; --list-config lists them")
      .value_name("FILE");
  command.add_flag("--compat", options.published,
                   "use the constants of published DiffSoup where Tureen's differ");
  add_number(command, "--triangles", options.triangles,
             "number of triangles at the end; 15,000 by default");
  add_number(command, "--steps", options.steps, "number of optimiser steps; 10,000 by default");
  add_number(command, "--batch", options.batch, "views per step; 4 by default");
  add_number(command, "--seed", options.seed, "seed of the random numbers; 0 by default")
      .check(refuse_seed);
  add_number(command, "--level", options.level,
             "finest lattice level: a face has (2^N + 1)(2^N + 2) / 2 texels");
  command
      .add_option("--init", options.begin,
                  "first triangles: random, points (structure-from-motion points of the dataset), "
                  "or a scene to "
                  "continue from; by default points if the dataset has them, else random")
      .value_name("WHERE");
}

Config base_config(const ConfigOptions& options, Preset otherwise) {
  const Preset kind = options.preset.value_or(otherwise);
  if (options.file.empty())
    return options.published ? trainer::published(kind) : trainer::preset(kind);
  const Config config = trainer::read_config(std::filesystem::path(options.file),
                                             {.preset = kind, .published = options.published});
  if (options.preset && config.preset != kind)
    throw UsageError("--preset and " + options.file + " name different presets");
  return config;
}

Config with_options(const Config& base, const ConfigOptions& options) {
  Config config = base;
  if (options.triangles) {
    const double ratio = double(*options.triangles) / config.triangles;
    config.initial_triangles =
        int(std::clamp(std::round(config.initial_triangles * ratio), 1.0, 4e6));
    config.triangles = as_int(*options.triangles, "triangles");
  }
  if (options.steps) config.steps = as_int(*options.steps, "steps");
  if (options.batch) config.batch = as_int(*options.batch, "batch");
  config.seed = options.seed.value_or(config.seed);
  if (options.level) {
    config.max_level = as_int(*options.level, "max_level");
    config.min_level = std::min(config.min_level, config.max_level);
    config.coarse_level = std::min(config.coarse_level, config.min_level);
  }
  if (options.begin == "random")
    config.initialisation = Initialisation::random;
  else if (options.begin == "points")
    config.initialisation = Initialisation::points;
  else if (!options.begin.empty())
    config.initialisation = Initialisation::mesh;
  if (const std::optional<std::string> reason = trainer::defect(config)) throw UsageError(*reason);
  return config;
}

}  // namespace tureen::cli
