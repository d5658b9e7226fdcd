// What a caller may ask of a renderer beside the soup.
#pragma once

#include <functional>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>

#include "runtime/plan.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen {

struct RenderOptions {
  PlanPreferences plan = {};
  /// What pixels without a face become: display-referred colour, and alpha (0 for transparent).
  glm::vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
  /// Pretend that the device can do no more than this (tests, forecasts).
  std::optional<DeviceLimits> limits = {};
  /// Called now and then with the fraction done, 0..1, while a preset changes the data, which takes
  /// seconds where it bakes a network; may throw to abandon the renderer.
  std::function<void(double)> progress = {};
};

/// A plan, and the soup that it is of where the knobs of the preset made another one.
struct PlannedSoup {
  RenderPlan plan;
  std::shared_ptr<const TriangleSoup> turned;
};

/// Throws UsageError and DeviceLimitError as make_plan does.
PlannedSoup plan_soup(const TriangleSoup& soup, const DeviceLimits& device,
                      const RenderOptions& options);

}  // namespace tureen
