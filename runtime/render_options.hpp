// What a caller may ask of a renderer beside the soup.
#pragma once

#include <glm/vec4.hpp>
#include <optional>

#include "runtime/plan/plan.hpp"

namespace tureen {

struct RenderOptions {
  PlanPreferences plan = {};
  /// What pixels without a face become: display-referred colour, and alpha (0 for transparent).
  glm::vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
  /// Pretend that the device can do no more than this (tests, forecasts).
  std::optional<DeviceLimits> limits = {};
};

}  // namespace tureen
