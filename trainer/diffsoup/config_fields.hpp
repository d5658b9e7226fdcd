// The table of all training constants: name, member of Config, range and meaning.
// The reader and the writer of --config files, the range check and --list-config use it. A test
// compares it with Config and fails if a member is missing here.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// The allowed numbers of a field, and the reason for the limits.
struct Range {
  enum class Ends { closed, low_open, high_open };
  double low = 0;
  double high = 0;
  Ends ends = Ends::closed;
  const char* reason = "";
  const char* reason_above = reason;  // the reason for numbers above `high`, if it differs

  bool contains(double value) const;
  /// "from 1 to 1024"; for an open end "more than 0, at most 1" or "from 0 to less than 1".
  std::string text() const;
  /// The error for a value outside the range: "0 is out of range; allowed: from 1 to 1024 (..)".
  /// `written`: the value as text in the file or on the command line.
  std::string refusal(double value, const std::string& written) const;
};

/// Three channels, display-referred.
using Color = float[3];

/// The member of Config for a field. Its type determines the value in a file: a whole number, a
/// number, true or false, three numbers, or one of `words`.
using Member = std::variant<int Config::*, std::uint64_t Config::*, float Config::*, bool Config::*,
                            Color Config::*, Preset Config::*, Initialisation Config::*,
                            GradientPrecision Config::*>;

struct ConfigField {
  const char* name;  // in files, and in Config
  Member member;
  Range range = {};                         // for numbers, and for each channel of a colour
  std::span<const char* const> words = {};  // for enumerations, in the order of the enumerators
  const char* meaning;                      // one line
};

/// All fields, in the order of Config.
std::span<const ConfigField> config_fields();

/// The names of the presets: "object", "scene".
std::span<const char* const> preset_words();

/// The first error of the configuration, for example "steps: 0 is out of range; allowed: from 1 to
/// 10000000 (a run needs at least one step)"; nothing if it is valid.
std::optional<std::string> defect(const Config& config);

/// The value in the form of a --config file: 0.8, true, "random", [1, 1, 1].
std::string value_text(const Config& config, const ConfigField& field);

/// All constants as text: name, default, different defaults of other presets, meaning, range or
/// words.
std::string config_reference();

}  // namespace tureen::trainer
