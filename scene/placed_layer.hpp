// Primitives with their place, for functions that draw layers from several scenes.
#pragma once

#include "scene/layer_place.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Refers to its primitives: one of the pointers is set. Nobody reads the bounds of `place`.
struct PlacedLayer {
  const TriangleSoup* soup = nullptr;
  const Splats* splats = nullptr;
  LayerPlace place = {};
};

inline PlacedLayer placed_layer(const Primitives& primitives, const LayerPlace& place) {
  return {std::get_if<TriangleSoup>(&primitives), std::get_if<Splats>(&primitives), place};
}
PlacedLayer placed_layer(Primitives&& primitives, const LayerPlace& place) = delete;
/// A visible soup whose vertices are relative to `origin`.
inline PlacedLayer placed_layer(const TriangleSoup& soup, const glm::dvec3& origin) {
  return {.soup = &soup, .place = {.world_from_layer = at_origin(origin)}};
}

/// The layers of a scene, with their labels as names.
inline std::vector<PlacedLayer> placed_layers(const Scene& scene) {
  std::vector<PlacedLayer> layers;
  for (const Layer& layer : scene.layers)
    layers.push_back(placed_layer(
        layer.primitives,
        {{}, layer.world_from_layer, layer.visible, label(layer, layers.size()), layer.material}));
  return layers;
}

/// The box around the primitives, in layer coordinates.
inline Bounds bounds(const PlacedLayer& layer) {
  return layer.soup ? bounds(*layer.soup) : bounds(*layer.splats);
}

}  // namespace tureen
