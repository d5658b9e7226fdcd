#include "runtime/prepared_scene.hpp"

#include <utility>

namespace tureen {

PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& limits,
                            RenderPlan plan) {
  PreparedScene prepared;
  prepared.plan = std::move(plan);
  const SoupPlan& soup_plan = prepared.plan.layers.front();
  prepared.layers.push_back(
      {.bounds = bounds(soup),
       .origin = origin,
       .soup =
           PreparedSoup{.appearance = prepare_appearance(soup, soup_plan, TexelLayout::of(limits)),
                        .geometry = prepare_geometry(soup, soup_plan.faces)}});
  return prepared;
}

PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                            const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device);
  return prepare_scene(soup, origin, limits, make_plan(soup, limits, options.plan));
}

}  // namespace tureen
