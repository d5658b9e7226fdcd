// The choice between the baseline and our own passes.
#include "jobs/baseline/baseline.hpp"

namespace tureen {

namespace {

Renderer renderer_of(const gl::Context& context, std::span<const PlacedSoup> layers,
                     PipelineKind kind, const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device_limits(context.capabilities()));
  if (kind == PipelineKind::tureen)
    return Renderer(context, prepare_scene(layers, limits, options), options);
  const PlacedSoup& only = layers.front();
  return Renderer(context,
                  prepare_baseline(only, limits, make_baseline_plan(only.soup, options.plan)),
                  options);
}

}  // namespace

Renderer make_renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                       PipelineKind kind, const RenderOptions& options) {
  const PlacedSoup layer{soup, at_origin(origin)};
  return renderer_of(context, std::span(&layer, 1), kind, options);
}

Renderer make_renderer(const gl::Context& context, const Scene& scene, PipelineKind kind,
                       const RenderOptions& options) {
  if (kind == PipelineKind::tureen)
    return Renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                    options);
  only_layer(scene);  // throws for several
  return renderer_of(context, placed_soups(scene), kind, options);
}

}  // namespace tureen
