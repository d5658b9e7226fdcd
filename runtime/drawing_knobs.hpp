// The knobs of a render preset that change the drawing and not the data: what a plan makes of them
// on this device, each with a sentence that begins "knob: ".
#pragma once

#include <optional>

#include "runtime/plan.hpp"

namespace tureen {

/// Where the caller or the preset wants colours to be made; nothing where the plan may choose.
/// Throws UsageError when the preset wants what the other site alone can do.
std::optional<ShadingSite> wanted_site(const PlanPreferences& preferences);

/// Sets feature_storage, depth_rejects_background, coverage_samples, resolution_scale and
/// supersampling of a plan whose site and color_mlp are decided. Throws UsageError for knobs that
/// the published pipeline does not have, DeviceLimitError where there is no multisampling.
void obey_drawing_knobs(const RenderPreset& preset, const DeviceLimits& limits, RenderPlan& plan);

}  // namespace tureen
