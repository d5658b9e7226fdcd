#include "runtime/prepared_scene.hpp"

#include <utility>

#include "base/error.hpp"
#include "runtime/layer_errors.hpp"
#include "scene/middle_bounds.hpp"

namespace tureen {

std::vector<PlacedSoup> placed_soups(const Scene& scene) {
  return placed_soups(placed_layers(scene));
}

PreparedScene prepare_scene(std::span<const PlacedSoup> layers, const DeviceLimits& limits,
                            RenderPlan plan) {
  PreparedScene prepared;
  prepared.plan = std::move(plan);
  const TexelLayout layout = TexelLayout::of(limits);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const PlacedSoup& layer = layers[i];
    const SoupPlan& soup_plan = prepared.plan.soup(i);
    PreparedSoup soup;
    with_layer_in_errors(layers.size() > 1 ? layer.name : "", [&] {
      soup = {.appearance = prepare_appearance(layer.soup, soup_plan, layout),
              .geometry = prepare_geometry(layer.soup, soup_plan.faces)};
    });
    prepared.layers.push_back({.name = layer.name,
                               .bounds = bounds(layer.soup),
                               .framed = bounds(layer.soup),
                               .world_from_layer = layer.world_from_layer,
                               .visible = layer.visible,
                               .soup = std::move(soup)});
  }
  return prepared;
}

PreparedScene prepare_scene(std::span<const PlacedSoup> layers, const DeviceLimits& device,
                            const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device);
  std::vector<const TriangleSoup*> soups;
  for (const PlacedSoup& layer : layers) soups.push_back(&layer.soup);
  return prepare_scene(layers, limits, make_plan(soups, limits, options.plan));
}

PreparedScene prepare_scene(std::span<const PlacedLayer> layers, const DeviceLimits& device,
                            const RenderOptions& options) {
  PreparedScene prepared = prepare_scene(placed_soups(layers), device, options);
  add_splats(prepared, layers, options.limits.value_or(device), options.plan);
  return prepared;
}

bool uses_tiles(const Splats& splats, const SplatPlan& plan, const DeviceLimits& limits,
                const PlanPreferences& preferences) {
  const SplatBlending blending = preferences.splat_blending;
  const Quality::SplatOrder order = preferences.quality.splat_order;
  if (order == Quality::SplatOrder::stochastic) {
    if (blending == SplatBlending::tiles)
      throw UsageError("tiles do not draw stochastic splats",
                       "use --blend raster or auto, or another splat order");
    return false;
  }
  const bool exact = order == Quality::SplatOrder::exact;
  if (exact && blending == SplatBlending::raster)
    throw UsageError("raster does not blend splats in exact order",
                     "use --blend tiles or auto, or another splat order");
  if (!exact && (blending == SplatBlending::raster ||
                 (blending == SplatBlending::automatic && !limits.software)))
    return false;
  if (!plan.as_published && splatting::has_layer_for(splats)) return true;
  if (blending == SplatBlending::tiles || exact)
    throw UsageError(plan.as_published ? "tiles do not have the culls of published rasterisers"
                                       : "tiles blend at most " +
                                             std::to_string(splatting::place_mask) + " splats",
                     exact ? "use another splat order: the exact one needs tiles"
                           : "--blend raster can, and auto chooses it");
  return false;
}

void add_splats(PreparedScene& prepared, std::span<const PlacedLayer> layers,
                const DeviceLimits& limits, const PlanPreferences& preferences) {
  const TexelLayout layout = TexelLayout::of(limits);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const PlacedLayer& layer = layers[i];
    const auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats) continue;
    const auto at = static_cast<std::ptrdiff_t>(i);
    SplatPlan plan = make_splat_plan(*splats, {.specialise = preferences.specialise,
                                               .specialisations = preferences.specialisations,
                                               .profile = preferences.splat_profile,
                                               .as_published = preferences.as_published});
    PreparedLayer prepared_layer{.name = layer.name,
                                 .bounds = bounds(*splats),
                                 .framed = framed_bounds(*splats),
                                 .world_from_layer = layer.world_from_layer,
                                 .visible = layer.visible};
    if (uses_tiles(*splats, plan, limits, preferences)) {
      prepared_layer.tiled_splats =
          splatting::layer_data(*splats, plan.profile, plan.drawn, plan.harmonics_degree);
    } else {
      // On hardware, the gain is not measured.
      if (limits.software && preferences.quality.splat_order != Quality::SplatOrder::stochastic &&
          preferences.specialise && preferences.specialisations.has(Specialisation::hidden_splats))
        plan.applied.push_back({Specialisation::hidden_splats, 0, 0, 0.5});
      prepared_layer.splats = prepare_splats(*splats, plan, layout);
    }
    prepared.layers.insert(prepared.layers.begin() + at, std::move(prepared_layer));
    prepared.plan.layers.insert(prepared.plan.layers.begin() + at, std::move(plan));
  }
}

std::vector<PlacedSoup> placed_soups(std::span<const PlacedLayer> layers) {
  std::vector<PlacedSoup> soups;
  for (const PlacedLayer& layer : layers)
    if (const auto* soup = std::get_if<TriangleSoup>(&layer.primitives))
      soups.push_back({*soup, layer.world_from_layer, layer.name, layer.visible});
  return soups;
}

std::vector<PlacedLayer> placed_layers(const Scene& scene) {
  std::vector<PlacedLayer> layers;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const Layer& layer = scene.layers[i];
    layers.push_back({layer.primitives, layer.world_from_layer, label(layer, i), layer.visible});
  }
  return layers;
}

PreparedScene prepare_scene(const Scene& scene, const DeviceLimits& device,
                            const RenderOptions& options) {
  return prepare_scene(placed_layers(scene), device, options);
}

PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                            const RenderOptions& options) {
  const PlacedSoup layer{soup, at_origin(origin)};
  return prepare_scene(std::span(&layer, 1), device, options);
}

}  // namespace tureen
