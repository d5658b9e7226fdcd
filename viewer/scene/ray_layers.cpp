#include "viewer/scene/ray_layers.hpp"

#include <utility>

namespace tureen::viewer {

std::vector<DocumentLayer> RayLayers::of(const SceneSource& source) {
  const std::map<LayerId, Changed> before = std::exchange(changed_, {});
  const std::optional<SplatProfile>& profile = source.document.profile;
  std::vector<DocumentLayer> layers = source.document.layers;
  for (DocumentLayer& layer : layers) {
    const Splats* const splats = splats_of(layer);
    if (!profile || !splats || splats->profile == *profile) continue;
    Changed changed{layer.primitives, nullptr};
    if (const auto known = before.find(layer.id);
        known != before.end() && known->second.stored == layer.primitives &&
        std::get<Splats>(*known->second.drawn).profile == *profile) {
      changed.drawn = known->second.drawn;
    } else {
      Splats drawn = *splats;
      drawn.profile = *profile;
      changed.drawn = std::make_shared<const Primitives>(std::move(drawn));
    }
    layer.primitives = changed.drawn;
    changed_.emplace(layer.id, std::move(changed));
  }
  return layers;
}

}  // namespace tureen::viewer
