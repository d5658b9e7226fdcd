// The one table of the constants of training: name, place in Config, range and meaning of each.
// The reader and the writer of --config files, the check of ranges and --list-config use it. A test
// compares it with Config: a member without a line here fails there.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// Which numbers a field may hold, and why no others.
struct Range {
  enum class Ends { closed, low_open, high_open };
  double low = 0;
  double high = 0;
  Ends ends = Ends::closed;
  const char* reason = "";
  const char* reason_above = reason;  // where numbers beyond `high` have a reason of their own

  bool contains(double value) const;
  /// "from 1 to 1024"; for an open end "more than 0, at most 1" or "from 0 to less than 1".
  std::string text() const;
  /// Why a value beyond it, which somebody wrote so, is refused: "0 is not from 1 to 1024 (...)".
  std::string refusal(double value, const std::string& written) const;
};

/// Three channels, display-referred.
using Color = float[3];

/// Where in Config a field lies; its type says what a file must hold: a whole number, a number,
/// true or false, three numbers, or one of `words`.
using Member = std::variant<int Config::*, std::uint64_t Config::*, float Config::*, bool Config::*,
                            Color Config::*, Preset Config::*, Initialisation Config::*,
                            GradientPrecision Config::*>;

struct ConfigField {
  const char* name;  // in files, and in Config
  Member member;
  Range range = {};                         // of numbers; of each channel of a colour
  std::span<const char* const> words = {};  // of enumerations, in the order of the enumerators
  const char* meaning;                      // one line
};

/// All fields, in the order of Config.
std::span<const ConfigField> config_fields();

/// The words that stand for the presets: "object", "scene".
std::span<const char* const> preset_words();

/// Why this configuration cannot be trained with, as in "steps: 0 is not in 1..10000000 (a run
/// takes at least one step)"; nothing where it can.
std::optional<std::string> defect(const Config& config);

/// The value as a --config file spells it: 0.8, true, "random", [1, 1, 1].
std::string value_text(const Config& config, const ConfigField& field);

/// All constants as text: name, default, the defaults of other presets where they differ, meaning,
/// range or words.
std::string config_reference();

}  // namespace tureen::trainer
