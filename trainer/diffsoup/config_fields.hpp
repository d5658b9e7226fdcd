// The table of all training constants: name, member of Config, range and meaning.
// The reader and the writer of --config files, the range check and --list-config use it. A test
// compares it with Config and fails if a member is missing here.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "trainer/common/config_table.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

using ConfigField = BasicConfigField<Config, Preset, Initialisation, GradientPrecision>;

/// All fields, in the order of Config.
std::span<const ConfigField> config_fields();

/// The names of the presets: "object", "scene".
std::span<const char* const> preset_words();

/// The first error of the configuration, for example "steps: 0 is out of range; allowed: from 1 to
/// 10000000 (a run needs at least one step)"; nothing if it is valid.
std::optional<std::string> defect(const Config& config);

/// All constants as text: name, default, different defaults of other presets, meaning, range or
/// words.
std::string config_reference();

}  // namespace tureen::trainer
