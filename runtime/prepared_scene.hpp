// The data that a renderer needs from a scene, prepared without a device: the plan, and functions
// that produce the device's data block by block. Preparation may run on another thread or in
// another process (web/engine/prepared_archive.hpp). The Renderer is then created where the context
// is current.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "runtime/passes/appearance_source.hpp"
#include "runtime/passes/geometry_source.hpp"
#include "runtime/passes/soup_passes.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/render_options.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// A soup before a device exists.
struct PreparedSoup {
  AppearanceSource appearance;
  GeometrySource geometry;
};

struct PreparedLayer {
  Bounds bounds;  // relative to the origin
  glm::dvec3 origin{0.0};
  /// Without it, passes from outside runtime/ hold the soup on the device.
  std::optional<PreparedSoup> soup;
};

/// The inputs of a function that makes passes.
struct PassInputs {
  const gl::Capabilities& device;
  const RenderPlan& plan;  // outlives the passes
  /// The prepared soups on the device, in order; they outlive the passes.
  std::span<const std::unique_ptr<DeviceSoup>> soups;
};

struct PreparedScene {
  RenderPlan plan;
  std::vector<PreparedLayer> layers;  // one for each of plan.layers
  /// Makes the passes of a frame, in the current context. May throw DeviceLimitError.
  std::function<Passes(const PassInputs&)> make_passes = [](const PassInputs& inputs) {
    return soup_passes(inputs.soups);
  };
};

/// Plans for the device's limits, or for options.limits. The sources read the soup, which must not
/// move until they have been used. The soup must have no defect(). Throws UsageError as make_plan
/// does, and DeviceLimitError with the memory that the soup needs if it does not fit.
PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                            const RenderOptions& options = {});
/// The same with a plan from make_plan for this soup and these limits.
PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& limits,
                            RenderPlan plan);

}  // namespace tureen
