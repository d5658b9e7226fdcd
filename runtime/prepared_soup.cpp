#include "runtime/prepared_soup.hpp"

#include <utility>

#include "runtime/render_options.hpp"

namespace tureen {

PreparedSoup prepare_soup(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& limits,
                          RenderPlan plan) {
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
  const DeviceLimits limits = options.limits.value_or(device);
  return prepare_soup(soup, origin, limits, make_plan(soup, limits, options.plan));
}

}  // namespace tureen
