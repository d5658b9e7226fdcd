#include "runtime/prepared_soup.hpp"

#include <cassert>
#include <utility>

#include "runtime/render_options.hpp"

namespace tureen {

PreparedSoup prepare_soup(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& limits,
                          RenderPlan plan) {
  assert(plan.pipeline == PipelineKind::tureen);
  PreparedSoup prepared;
  prepared.plan = std::move(plan);
  prepared.bounds = bounds(soup);
  prepared.origin = origin;
  prepared.appearance = prepare_appearance(soup, prepared.plan, TexelLayout::of(limits));
  prepared.geometry = prepare_geometry(soup, prepared.plan.faces);
  return prepared;
}

PreparedSoup prepare_soup(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                          const RenderOptions& options) {
  PlannedSoup planned = plan_soup(soup, device, options);
  const TriangleSoup& drawn = planned.turned ? *planned.turned : soup;
  PreparedSoup prepared =
      prepare_soup(drawn, origin, options.limits.value_or(device), std::move(planned.plan));
  prepared.turned = std::move(planned.turned);
  return prepared;
}

}  // namespace tureen
