// All that a renderer wants to know of a soup, found without a device: what is drawn, and the bytes
// that go to the device, block by block when they are asked for. A program makes it where it will,
// on a thread or in another process (web/engine/prepared_archive.hpp), and a Renderer of it where
// the context is.
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

/// Plans for the device's limits, or for options.limits.
/// The sources read the soup, which must stay where it is until they have been used. The soup must
/// have no defect(); the pipeline must be ours. Throws UsageError and DeviceLimitError as Renderer
/// does.
PreparedSoup prepare_soup(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                          const RenderOptions& options);
/// The same with a plan that make_plan made of this soup for such limits.
PreparedSoup prepare_soup(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& limits,
                          RenderPlan plan);

}  // namespace tureen
