// The constants of training on the command line: a preset, a file, and the few that people change
// from run to run. Whatever else there is, a file sets (--list-config).
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
  std::optional<std::int64_t> triangles, steps, batch, level;  // ranges are checked in the end
  std::optional<std::uint64_t> seed;
  std::string begin;  // "random", "points", a scene, or empty

  /// Whether anything but single constants is given: then they stand on a preset of their own.
  bool name_a_base() const { return preset || published || !file.empty(); }
  /// The scene that triangles are taken from; empty for none.
  std::string mesh() const;
};

/// --preset, --config, --compat, --triangles, --steps, --batch, --seed, --level and --init.
/// `options` must live until the arguments are parsed.
void add_config_options(Command& command, ConfigOptions& options);

/// The preset, or the file on top of it; `otherwise` where neither names a preset. Throws
/// InputError for the file, UsageError where it and --preset disagree.
trainer::Config base_config(const ConfigOptions& options, trainer::Preset otherwise);

/// `base` with the single constants. --triangles changes the triangles to begin with in proportion,
/// --level lowers the other levels where they were above. Throws UsageError for what cannot be
/// trained with.
trainer::Config with_options(const trainer::Config& base, const ConfigOptions& options);

}  // namespace tureen::cli
