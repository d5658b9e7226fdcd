#include "runtime/prepared_scene.hpp"

#include <utility>

#include "runtime/layer_errors.hpp"
#include "scene/middle_bounds.hpp"

namespace tureen {

PreparedScene prepare_scene(std::span<const PlacedLayer> layers, const DeviceLimits& limits,
                            RenderPlan plan) {
  PreparedScene prepared;
  prepared.plan = std::move(plan);
  const TexelLayout layout = TexelLayout::of(limits);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const PlacedLayer& placed = layers[i];
    PreparedLayer layer{.place = placed.place};
    layer.place.bounds = bounds(placed);
    layer.framed = placed.soup ? layer.place.bounds : framed_bounds(*placed.splats);
    with_layer_in_errors(layers.size() > 1 ? placed.place.name : "", [&] {
      if (placed.soup) {
        const SoupPlan& soup_plan = prepared.plan.soup(i);
        layer.soup = {.appearance = prepare_appearance(*placed.soup, soup_plan, layout),
                      .geometry = prepare_geometry(*placed.soup, soup_plan.faces)};
        return;
      }
      const Splats& splats = *placed.splats;
      const SplatPlan& splat_plan = prepared.plan.splats(i);
      if (prepared.plan.splats_in_tiles)
        layer.tiled_splats = splatting::layer_data(splats, splat_plan.profile, splat_plan.drawn,
                                                   splat_plan.harmonics_degree);
      else
        layer.splats = prepare_splats(splats, splat_plan, layout);
    });
    prepared.layers.push_back(std::move(layer));
  }
  return prepared;
}

PreparedScene prepare_scene(std::span<const PlacedLayer> layers, const DeviceLimits& device,
                            const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device);
  return prepare_scene(layers, limits, make_plan(layers, limits, options.plan));
}

PreparedScene prepare_scene(const Scene& scene, const DeviceLimits& device,
                            const RenderOptions& options) {
  return prepare_scene(placed_layers(scene), device, options);
}

PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                            const RenderOptions& options) {
  const PlacedLayer layer = placed_layer(soup, origin);
  return prepare_scene(std::span(&layer, 1), device, options);
}

}  // namespace tureen
