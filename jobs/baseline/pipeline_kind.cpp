// The choice between the baselines and our own passes, and between the baselines.
#include "jobs/baseline/baseline.hpp"
#include "jobs/baseline/baseline_passes.hpp"
#include "scene/middle_bounds.hpp"

namespace tureen {

namespace {

Renderer make_renderer(const gl::Context& context, const PlacedLayer& layer, RenderPlan plan,
                       const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  return Renderer(context, prepare_baseline(layer, limits, std::move(plan)), options);
}

}  // namespace

PreparedScene prepare_baseline(const PlacedLayer& layer, const DeviceLimits& limits,
                               RenderPlan plan) {
  PreparedLayer prepared{.place = layer.place};
  prepared.place.bounds = bounds(layer);
  prepared.framed = layer.soup ? prepared.place.bounds : framed_bounds(*layer.splats);
  MakePasses make_passes = layer.soup ? baseline_passes(*layer.soup, limits)
                                      : baseline_passes(*layer.splats, plan.splats(0), limits);
  return {std::move(plan), {std::move(prepared)}, std::move(make_passes)};
}

Renderer make_renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                       PipelineKind kind, const RenderOptions& options) {
  if (kind == PipelineKind::baseline)
    return make_renderer(context, placed_layer(soup, origin),
                         make_baseline_plan(soup, options.plan), options);
  const DeviceLimits limits = device_limits(context.capabilities());
  return Renderer(context, prepare_scene(soup, origin, limits, options), options);
}

Renderer make_renderer(const gl::Context& context, const Scene& scene, PipelineKind kind,
                       const RenderOptions& options) {
  if (kind == PipelineKind::baseline) {
    RenderPlan plan = make_baseline_plan(only_layer(scene).primitives, options.plan);
    return make_renderer(context, placed_layers(scene).front(), std::move(plan), options);
  }
  const DeviceLimits limits = device_limits(context.capabilities());
  return Renderer(context, prepare_scene(scene, limits, options), options);
}

}  // namespace tureen
