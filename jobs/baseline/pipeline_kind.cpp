// The choice between the baseline and our own passes.
#include "jobs/baseline/baseline.hpp"

namespace tureen {

Renderer make_renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                       PipelineKind kind, const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  return Renderer(
      context,
      kind == PipelineKind::tureen
          ? prepare_scene(soup, origin, limits, options)
          : prepare_baseline(soup, origin, limits, make_baseline_plan(soup, options.plan)),
      options);
}

Renderer make_renderer(const gl::Context& context, const Scene& scene, PipelineKind kind,
                       const RenderOptions& options) {
  if (kind == PipelineKind::baseline)
    return make_renderer(context, only_soup(scene), origin_of(only_layer(scene)), kind, options);
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  return Renderer(context, prepare_scene(scene, limits, options), options);
}

}  // namespace tureen
