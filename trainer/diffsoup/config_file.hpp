// Configurations as files (--config): one flat JSON object whose keys are the fields of Config.
//
//   { "preset": "scene", "steps": 5000, "background": [1, 1, 1] }
//
// Constants that a file does not name keep their defaults; config_reference() lists all fields.
#pragma once

#include <string>

#include "base/input.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// Defaults for fields that are not in the file.
struct ConfigDefaults {
  Preset preset = Preset::object;  // if the file has no preset
  bool published = false;          // published() instead of preset()
};

/// Throws InputError with the file and the field: for text that is not a JSON object, for an
/// unknown field (suggests the nearest one), for a value of a wrong type, and for a value that is
/// out of range or conflicts with another (with the reason).
Config read_config(Input input, const ConfigDefaults& defaults = {});

/// All fields, one per line; read_config returns the same bits from it.
std::string config_to_json(const Config& config);

}  // namespace tureen::trainer
