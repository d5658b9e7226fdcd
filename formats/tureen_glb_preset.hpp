// A RenderPreset as the JSON of TUREEN_triangle_soup has it: the knobs that are not at their
// defaults, by name. Include it in sources only.
#pragma once

#include <nlohmann/json.hpp>

#include "formats/json_view.hpp"
#include "soup/render_preset.hpp"

namespace tureen {

/// Without keeps_face, which lies in the binary chunk.
nlohmann::json preset_json(const RenderPreset& preset);

/// Keys that it does not know are ignored. A value of the wrong kind or out of its range throws
/// InputError with its path; what else may be wrong with a preset only defect() tells.
RenderPreset read_preset(const JsonView& view);

}  // namespace tureen
