// Options of a renderer.
#pragma once

#include <glm/vec4.hpp>
#include <optional>

#include "runtime/plan/plan.hpp"

namespace tureen {

struct RenderOptions {
  PlanPreferences plan = {};
  /// Display-referred colour and alpha (0: transparent) of pixels without a face.
  glm::vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
  SplatFormat splat_format = SplatFormat::automatic;
  /// Limits that replace those of the device (tests, forecasts).
  std::optional<DeviceLimits> limits = {};
};

}  // namespace tureen
