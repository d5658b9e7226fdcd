// The member "preset" of TUREEN_triangle_soup: how finely a scene is sampled, and in files of
// earlier versions also how its data are to be reduced. Include it in sources only.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json_view.hpp"
#include "scene/edit/edits.hpp"
#include "scene/quality.hpp"

namespace tureen {

/// The values that are not at their defaults.
nlohmann::json quality_json(const Quality& quality);

struct StoredPreset {
  Quality quality;
  /// Only in files of earlier versions; without keeps_face, which lies in the binary chunk.
  Edits edits;
  /// Keys of settings that no longer exist.
  std::vector<std::string> ignored;
};

/// Keys that no version ever had are ignored without a trace. A value of the wrong kind or out of
/// its range throws InputError with its path.
StoredPreset read_preset(const JsonView& view);

}  // namespace tureen
