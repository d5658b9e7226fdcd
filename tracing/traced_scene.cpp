#include "tracing/traced_scene.hpp"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

#include "tracing/appearance.hpp"
#include "tracing/kernels/ray_kernel.hpp"
#include "tracing/optics.hpp"

namespace tureen::tracing {

namespace {

/// Beyond all distances of hits.
constexpr float unlimited = 3e38f;
/// Splats are collected up to this multiple of the distance at which the ray before was saturated;
/// if this ray is not, the rest at once. Neighbouring rays are saturated at distances that differ
/// by a few percent.
constexpr float reach_factor = 1.03f;

float distance_of(const SplatOnRay& hit) {
  return std::bit_cast<float>(std::uint32_t(hit.key >> 32));
}

/// The point of a surface, and its normals towards the side of the ray.
struct SurfacePoint {
  glm::dvec3 point, flat, smooth;
  bool from_outside;

  SurfacePoint(const TracedLayer& layer, const SurfaceOnRay& surface, const Ray& ray) {
    const auto& soup = std::get<TriangleSoup>(layer.primitives());
    const glm::uvec3& t = soup.triangles[surface.face.face];
    const glm::dvec3 a(soup.positions[t[0]]), b(soup.positions[t[1]]), c(soup.positions[t[2]]);
    point = layer.point_in_world(c + surface.b0 * (a - c) + surface.b1 * (b - c));
    flat = glm::normalize(layer.to_world(glm::cross(b - a, c - a)));
    from_outside = glm::dot(flat, ray.direction) < 0;
    smooth = flat;
    if (!soup.normals.empty()) {
      const glm::dvec3 na(soup.normals[t[0]]), nb(soup.normals[t[1]]), nc(soup.normals[t[2]]);
      const glm::dvec3 mean = nc + surface.b0 * (na - nc) + surface.b1 * (nb - nc);
      // A normal of 0 marks a flat face; opposite ones have no mean.
      if (glm::length(mean) > 1e-6) smooth = glm::normalize(layer.to_world(mean));
      if (glm::dot(smooth, flat) < 0) smooth = -smooth;
    }
    if (!from_outside) flat = -flat, smooth = -smooth;
    if (!(glm::dot(smooth, ray.direction) < 0)) smooth = flat;
  }

  bool is_outgoing(const glm::dvec3& direction) const { return glm::dot(direction, flat) > 0; }
};

Ray next_ray(const Ray& ray, const SurfaceOnRay& surface, const glm::dvec3& point,
             const glm::dvec3& direction) {
  return {point, direction, ray.path + surface.distance, ray.pixel, surface.face};
}

}  // namespace

std::vector<DocumentLayer> layers_for_rays(const Scene& scene) {
  std::vector<DocumentLayer> result;
  for (const Layer& layer : scene.layers)
    result.push_back(
        {{{}, layer.world_from_layer, layer.visible, layer.name, layer.material},
         result.size() + 1,
         std::shared_ptr<const Primitives>(std::shared_ptr<void>(), &layer.primitives)});
  return result;
}

TracedScene::TracedScene(const Scene& scene, const glm::vec3& background, const Parallel& parallel)
    : TracedScene(background) {
  sync(layers_for_rays(scene), parallel);
}

TracedLayer& TracedScene::tree_of(const DocumentLayer& layer, const Parallel& parallel) {
  const auto known = std::find_if(trees_.begin(), trees_.end(),
                                  [&](const Tree& tree) { return tree.id == layer.id; });
  if (known != trees_.end() && known->primitives == layer.primitives) return *known->layer;
  Tree tree{layer.id, layer.primitives, {}};
  if (known != trees_.end()) {  // it is lost if `parallel` throws
    if (known->layer->can_refit(*layer.primitives)) tree.layer = std::move(known->layer);
    trees_.erase(known);
  }
  if (tree.layer)
    tree.layer->refit(*layer.primitives, parallel);
  else
    tree.layer =
        std::make_unique<TracedLayer>(*layer.primitives, layer.world_from_layer, 0, 0, parallel);
  trees_.push_back(std::move(tree));
  return *trees_.back().layer;
}

void TracedScene::sync(const std::vector<DocumentLayer>& layers, const Parallel& parallel) {
  std::erase_if(trees_, [&](const Tree& tree) {
    return std::none_of(layers.begin(), layers.end(),
                        [&](const DocumentLayer& layer) { return layer.id == tree.id; });
  });
  shown_.assign(layers.size(), nullptr);
  materials_.clear();
  surfaces_.clear();
  splats_.clear();
  std::uint32_t first = 0;  // of the next layer's splats
  for (std::uint32_t i = 0; i < layers.size(); ++i) {
    materials_.push_back(layers[i].material);
    if (!layers[i].visible) continue;
    TracedLayer& layer = tree_of(layers[i], parallel);
    layer.move(layers[i].world_from_layer, i, first);
    shown_[i] = &layer;
    const auto* splats = std::get_if<Splats>(layers[i].primitives.get());
    (splats ? splats_ : surfaces_).push_back(&layer);
    if (splats) first += std::uint32_t(count(*splats));
  }
}

SurfaceOnRay TracedScene::surface_on(const Ray& ray) const {
  SurfaceOnRay nearest;
  for (const TracedLayer* layer : surfaces_) layer->kernel().intersect(*layer, ray, nearest);
  return nearest;
}

BlendedSplats TracedScene::splats_on(const Ray& ray, double end, RayMemory& memory,
                                     int depth) const {
  BlendedSplats result;
  if (splats_.empty()) return result;
  memory.layers.clear();
  for (const TracedLayer* each : splats_) memory.layers.push_back(each->in_layer(ray, end));
  const auto layer_of = [&](const SplatOnRay& hit) {
    std::size_t i = splats_.size() - 1;
    while (splats_[i]->first() > hit.place()) --i;
    return i;
  };

  float& reach = memory.reach[std::size_t(depth)];
  float from = 0, to = reach > 0 ? reach : unlimited;
  const float last = std::min(unlimited, float(end));
  for (;;) {
    memory.hits.clear();
    for (std::size_t i = 0; i < splats_.size(); ++i)
      splats_[i]->kernel().collect()(*splats_[i], memory.layers[i], from, to, memory.hits);
    std::sort(memory.hits.begin(), memory.hits.end(),
              [](const SplatOnRay& a, const SplatOnRay& b) { return a.key < b.key; });
    for (const SplatOnRay& hit : memory.hits) {
      const std::size_t i = layer_of(hit);
      const TracedLayer& layer = *splats_[i];
      const double next = result.transmittance * (1 - double(hit.alpha));
      const bool stops =
          next < double(std::get<Splats>(layer.primitives()).profile.stop_transmittance);
      if (!stops) {
        const double weight = result.transmittance * double(hit.alpha);
        result.color +=
            weight * glm::dvec3(layer.kernel().color(layer, memory.layers[i], hit.lane));
        result.transmittance = next;
      }
      if (stops || next == 0) {
        reach = reach_factor * distance_of(hit);
        return result;
      }
    }
    if (!(to < last)) break;
    from = to;
    to = unlimited;
  }
  reach = 0;
  return result;
}

glm::dvec3 TracedScene::light_along(const Ray& ray, double weight, int depth,
                                    RayMemory& memory) const {
  if (depth > max_depth || !(weight >= least_weight)) return background_;
  const SurfaceOnRay surface = surface_on(ray);
  const BlendedSplats splats = splats_on(ray, surface.distance, memory, depth);
  glm::dvec3 behind = background_;
  if (surface.exists())
    behind = light_of(surface, ray, weight * splats.transmittance, depth, memory);
  return splats.color + splats.transmittance * behind;
}

glm::dvec3 TracedScene::light_of(const SurfaceOnRay& surface, const Ray& ray, double weight,
                                 int depth, RayMemory& memory) const {
  const TracedLayer& own = layer(surface.face.layer);
  const std::optional<Material>& material = materials_[surface.face.layer];
  if (material && is_glass(*material)) return light_of_glass(surface, ray, weight, depth, memory);
  if (material && is_mirror(*material)) {
    const SurfacePoint at(own, surface, ray);
    glm::dvec3 reflected = reflection(ray.direction, at.smooth);
    if (!at.is_outgoing(reflected)) reflected = reflection(ray.direction, at.flat);
    const glm::dvec3 color(material->base_color);
    const double counts = weight * std::max({color.r, color.g, color.b});
    return color *
           light_along(next_ray(ray, surface, at.point, reflected), counts, depth + 1, memory);
  }
  const auto& soup = std::get<TriangleSoup>(own.primitives());
  const RayInLayer in_layer = own.in_layer(ray, surface.distance);
  return surface_color(soup, {surface.face.face, surface.b0, surface.b1},
                       {-in_layer.direction, in_layer.eye});
}

glm::dvec3 TracedScene::light_of_glass(const SurfaceOnRay& surface, const Ray& ray, double weight,
                                       int depth, RayMemory& memory) const {
  const Material& material = *materials_[surface.face.layer];
  const SurfacePoint at(layer(surface.face.layer), surface, ray);
  const double inside = double(material.ior);
  const double n1 = at.from_outside ? 1.0 : inside, n2 = at.from_outside ? inside : 1.0;
  Splitting light = at_boundary(ray.direction, at.smooth, n1, n2);
  const bool is_refracted = light.reflectance < 1;
  if (!at.is_outgoing(light.reflected) || (is_refracted && at.is_outgoing(light.refracted)))
    light = at_boundary(ray.direction, at.flat, n1, n2);
  const double part = light.reflectance;
  glm::dvec3 sum = part * light_along(next_ray(ray, surface, at.point, light.reflected),
                                      part * weight, depth + 1, memory);
  if (part < 1) {
    const glm::dvec3 color(material.base_color);
    const double counts = (1 - part) * weight * std::max({color.r, color.g, color.b});
    sum +=
        (1 - part) * color *
        light_along(next_ray(ray, surface, at.point, light.refracted), counts, depth + 1, memory);
  }
  return sum;
}

}  // namespace tureen::tracing
