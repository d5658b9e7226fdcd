#include "scene/near_limit.hpp"

#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "scene/middle_bounds.hpp"
#include "scene/scene_remarks.hpp"

namespace tureen {

namespace {

/// World units per layer unit of a similarity.
double scale_of(const glm::dmat4& world_from_layer) {
  return glm::length(glm::dvec3(world_from_layer[0]));
}

}  // namespace

std::optional<float> lower_near_limit(const Splats& splats) {
  const double limit = splats.profile.min_center_depth;
  if (!(limit > 0) || count(splats) == 0) return {};
  const double radius = middle_bounds(splats).radius();
  if (!(radius > 0 && radius < 2 * limit)) return {};
  return float(radius / 10);
}

HiddenSplats hidden_by_near_limit(const Splats& splats, const glm::dmat4& world_from_layer,
                                  const Camera& camera) {
  const double limit = splats.profile.min_center_depth * scale_of(world_from_layer);
  HiddenSplats result;
  if (!(limit > 0)) return result;
  for (std::size_t i = 0; i < count(splats); ++i) {
    const glm::dvec3 at(world_from_layer * glm::dvec4(center(splats, i), 1.0));
    if (!in_image(camera, at)) continue;
    ++result.in_view;
    if (-(camera.view_from_world * glm::dvec4(at, 1.0)).z <= limit) ++result.hidden;
  }
  return result;
}

std::optional<Remark> near_limit_remark(const Scene& scene) {
  for (const Layer& layer : scene.layers) {
    const auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats || !layer.visible || !(splats->profile.min_center_depth > 0)) continue;
    const double limit =
        double(splats->profile.min_center_depth) * scale_of(layer.world_from_layer);
    if (!scene.cameras.empty()) {
      const HiddenSplats view =
          hidden_by_near_limit(*splats, layer.world_from_layer, scene.cameras.front());
      if (100 * view.hidden > view.in_view)
        return Remark{&remarks::near_limit_hides,
                      {{"limit", limit}, {"hidden", double(view.hidden) / double(view.in_view)}}};
    } else if (lower_near_limit(*splats)) {
      const double radius = middle_bounds(*splats).radius() * scale_of(layer.world_from_layer);
      return Remark{&remarks::near_limit_large, {{"limit", limit}, {"radius", radius}}};
    }
  }
  return {};
}

void choose_near_limit(Scene& scene, double units) {
  bool found = false;
  for (Layer& layer : scene.layers)
    if (auto* splats = std::get_if<Splats>(&layer.primitives)) {
      splats->profile.min_center_depth = float(units / scale_of(layer.world_from_layer));
      found = true;
    }
  if (!found) throw UsageError("a near limit applies to splats; the scene has none");
  std::erase_if(scene.info.remarks, [](const Remark& remark) {
    return remark.kind->setting == std::string_view("near_limit");
  });
}

}  // namespace tureen
