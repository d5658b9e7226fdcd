// The training constants on the command line: a preset, a file, and the most common single
// constants. A file can set all constants (--list-config).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/options/arguments.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::cli {

struct ConfigOptions {
  std::optional<trainer::Preset> preset;
  std::string file;
  bool published = false;
  std::optional<std::int64_t> triangles, steps, batch, level;  // with_options() checks ranges
  std::optional<std::uint64_t> seed;
  std::string begin;  // "random", "points", a scene, or empty

  /// Whether a preset, a file or --compat is given. Single constants then change these instead of
  /// the constants of a checkpoint.
  bool name_a_base() const { return preset || published || !file.empty(); }
  /// The scene that provides the first triangles; empty: none.
  std::string mesh() const;
};

/// --preset, --config, --compat, --triangles, --steps, --batch, --seed, --level and --init.
/// `options` must live until the arguments are parsed.
void add_config_options(Command& command, ConfigOptions& options);

/// The preset, with the file's constants. `otherwise`: the preset if neither names one. Throws
/// InputError for an invalid file, UsageError if it names another preset than --preset.
trainer::Config base_config(const ConfigOptions& options, trainer::Preset otherwise);

/// `base` with the single constants. --triangles scales the initial number of triangles in
/// proportion. --level also limits the other levels. Throws UsageError for invalid constants.
trainer::Config with_options(const trainer::Config& base, const ConfigOptions& options);

}  // namespace tureen::cli
