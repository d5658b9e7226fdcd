// The data that a renderer needs from a soup, prepared without a device: the plan, and functions
// that produce the device's data block by block. Preparation may run on another thread or in
// another process (web/engine/prepared_archive.hpp). The Renderer is then created where the context
// is current.
#pragma once

#include <glm/vec3.hpp>

#include "runtime/passes/appearance_source.hpp"
#include "runtime/passes/geometry_source.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct RenderOptions;

struct PreparedSoup {
  RenderPlan plan;
  Bounds bounds;
  glm::dvec3 origin{0.0};
  AppearanceSource appearance;
  GeometrySource geometry;
};

/// Plans for the device's limits, or for options.limits. The sources read the soup, which must not
/// move until they have been used. The soup must have no defect(). Throws UsageError and
/// DeviceLimitError as Renderer does.
PreparedSoup prepare_soup(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                          const RenderOptions& options);
/// The same with a plan from make_plan for this soup and these limits.
PreparedSoup prepare_soup(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& limits,
                          RenderPlan plan);

}  // namespace tureen
