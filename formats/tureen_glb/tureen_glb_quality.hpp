// The member "preset" of TUREEN_triangle_soup: the sampling quality, and in files of earlier
// versions also edits of the data. Include it only in sources.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json/json_view.hpp"
#include "scene/edit/edits.hpp"
#include "scene/quality.hpp"

namespace tureen {

/// The values that differ from their defaults.
nlohmann::json quality_json(const Quality& quality);

struct StoredPreset {
  Quality quality;
  /// Only in files of earlier versions; without keeps_face, which is in the binary chunk.
  Edits edits;
  /// Keys of settings that no longer exist.
  std::vector<std::string> ignored;
};

/// Unknown keys that no version had are ignored without a remark. A value of the wrong kind or out
/// of range throws InputError with its path.
StoredPreset read_preset(const JsonView& view);

}  // namespace tureen
