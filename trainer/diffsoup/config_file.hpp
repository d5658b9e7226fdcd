// Configurations as files (--config): one flat JSON object whose keys are the fields of Config.
//
//   { "preset": "scene", "steps": 5000, "background": [1, 1, 1] }
//
// Constants that a file does not name keep their defaults; config_reference() lists all fields.
#pragma once

#include <filesystem>
#include <string>

#include "base/input.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// What the fields are that a file does not name.
struct ConfigDefaults {
  Preset preset = Preset::object;  // where the file names none
  bool published = false;          // published() instead of preset()
};

/// Throws InputError with the file and the field: text that is no JSON object, a name that is no
/// field (with the nearest that is), a value of another type, one out of range or at odds with
/// another (with the reason).
Config read_config(Input& input, const ConfigDefaults& defaults = {});
Config read_config(const std::filesystem::path& path, const ConfigDefaults& defaults = {});

/// All fields, a line each; reading it back gives the same bits.
std::string config_to_json(const Config& config);

}  // namespace tureen::trainer
