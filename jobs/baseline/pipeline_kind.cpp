// The choice between the baselines and our own passes, and between the baselines.
#include "jobs/baseline/baseline.hpp"

namespace tureen {

PreparedScene prepare_baseline(const PlacedLayer& layer, const DeviceLimits& limits,
                               RenderPlan plan) {
  if (const auto* splats = std::get_if<Splats>(&layer.primitives))
    return prepare_baseline(
        PlacedSplats{*splats, layer.world_from_layer, layer.name, layer.visible}, limits,
        std::move(plan));
  return prepare_baseline(PlacedSoup{std::get<TriangleSoup>(layer.primitives),
                                     layer.world_from_layer, layer.name, layer.visible},
                          limits, std::move(plan));
}

Renderer make_renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                       PipelineKind kind, const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  const PlacedSoup layer{soup, at_origin(origin)};
  if (kind == PipelineKind::tureen)
    return Renderer(context, prepare_scene(std::span(&layer, 1), limits, options), options);
  return Renderer(context, prepare_baseline(layer, limits, make_baseline_plan(soup, options.plan)),
                  options);
}

Renderer make_renderer(const gl::Context& context, const Scene& scene, PipelineKind kind,
                       const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  if (kind == PipelineKind::tureen)
    return Renderer(context, prepare_scene(scene, limits, options), options);
  RenderPlan plan = make_baseline_plan(only_layer(scene).primitives, options.plan);
  return Renderer(context, prepare_baseline(placed_layers(scene).front(), limits, std::move(plan)),
                  options);
}

}  // namespace tureen
