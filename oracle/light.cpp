#include "oracle/light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "oracle/shade.hpp"
#include "oracle/splats.hpp"
#include "scene/clip_range.hpp"

namespace tureen::oracle {

namespace {

constexpr int most_turns = 8;
constexpr double least = 1.0 / 510;

const TriangleSoup& soup_of(const Layer& layer) { return std::get<TriangleSoup>(layer.primitives); }

struct Corners {
  glm::dvec3 a, b, c;

  Corners(const TriangleSoup& soup, std::size_t face)
      : a(soup.positions[soup.triangles[face][0]]),
        b(soup.positions[soup.triangles[face][1]]),
        c(soup.positions[soup.triangles[face][2]]) {}
};

/// The part of unpolarised light that is reflected, by the angles in air and glass (Born and Wolf,
/// 1.5.2, equations 32 and 33).
double reflected_part(double sine_in, double sine_out, double n1, double n2) {
  const double in = std::asin(sine_in), out = std::asin(sine_out);
  if (sine_in < 1e-6) return (n1 - n2) * (n1 - n2) / ((n1 + n2) * (n1 + n2));
  const double s = std::sin(in - out) / std::sin(in + out);
  const double p = std::tan(in - out) / std::tan(in + out);
  return (s * s + p * p) / 2;
}

}  // namespace

Light::Light(const Scene& scene, const glm::vec3& background)
    : scene_(scene), background_(background) {
  for (const Layer& layer : scene.layers) {
    Own own;
    const glm::dmat3 linear(layer.world_from_layer);
    own.layer_from_world = glm::inverse(linear);
    own.scale = std::cbrt(std::abs(glm::determinant(linear)));
    if (const auto* splats = std::get_if<Splats>(&layer.primitives); splats && layer.visible)
      own.splats.emplace(*splats);
    layers_.push_back(std::move(own));
  }
}

LightRay Light::in_layer(const LightRay& ray, std::size_t layer) const {
  const Own& own = layers_[layer];
  const glm::dvec3 origin(scene_.layers[layer].world_from_layer[3]);
  return {own.layer_from_world * (ray.origin - origin),
          glm::normalize(own.layer_from_world * ray.direction), ray.path / own.scale, ray.pixel};
}

Light::Surface Light::nearest(const LightRay& ray, const Face& from) const {
  Surface best;
  for (std::size_t i = 0; i < scene_.layers.size(); ++i) {
    const auto* soup = std::get_if<TriangleSoup>(&scene_.layers[i].primitives);
    if (!soup || !scene_.layers[i].visible) continue;
    const LightRay own = in_layer(ray, i);
    const glm::dvec3 origin(scene_.layers[i].world_from_layer[3]);
    // A face at the start of the ray is where it starts: rounding of coordinates of this size.
    const double start =
        1e-14 * (glm::length(own.origin) +
                 (glm::length(ray.origin) + glm::length(origin)) / layers_[i].scale);
    for (std::size_t face = 0; face < soup->triangles.size(); ++face) {
      if (Face{i, face} == from) continue;
      const Corners corners(*soup, face);
      // own.origin + t d = c + b0 (a - c) + b1 (b - c), by Cramer's rule.
      const glm::dvec3 e0 = corners.a - corners.c, e1 = corners.b - corners.c;
      const glm::dvec3 offset = own.origin - corners.c;
      const double volume = glm::determinant(glm::dmat3(e0, e1, -own.direction));
      const double b0 = glm::determinant(glm::dmat3(offset, e1, -own.direction)) / volume;
      const double b1 = glm::determinant(glm::dmat3(e0, offset, -own.direction)) / volume;
      const double distance = glm::determinant(glm::dmat3(e0, e1, offset)) / volume;
      if (!(b0 >= 0 && b1 >= 0 && b0 + b1 <= 1 && distance > start)) continue;
      if (distance * layers_[i].scale < best.distance &&
          is_visible(*soup, {std::uint32_t(face), b0, b1}))
        best = {{i, face}, b0, b1, distance * layers_[i].scale};
    }
  }
  return best;
}

glm::dvec3 Light::along(const LightRay& ray, const std::optional<Face>& from, double weight,
                        int depth) const {
  if (depth > most_turns || !(weight >= least)) return background_;
  const Surface surface = nearest(ray, from.value_or(Face{~std::size_t(0), 0}));
  struct Candidate {
    SplatOnRay splat;
    std::size_t layer, index;
  };
  std::vector<Candidate> candidates;
  std::vector<SplatsOnRays::Found> found;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    if (!layers_[i].splats) continue;
    found.clear();
    layers_[i].splats->find(in_layer(ray, i), surface.distance / layers_[i].scale, found);
    for (SplatsOnRays::Found& each : found) {
      each.splat.distance *= layers_[i].scale;
      candidates.push_back({each.splat, i, each.index});
    }
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.splat.distance < b.splat.distance; });
  glm::dvec3 color(0);
  double transmittance = 1;
  for (const Candidate& each : candidates) {
    const double next = transmittance * (1 - each.splat.alpha);
    const auto& splats = std::get<Splats>(scene_.layers[each.layer].primitives);
    if (next < double(splats.profile.stop_transmittance)) break;
    color += transmittance * each.splat.alpha * each.splat.color;
    transmittance = next;
  }
  const bool is_open = surface.face.layer == ~std::size_t(0);
  return color +
         transmittance * (is_open ? background_ : of(surface, ray, weight * transmittance, depth));
}

glm::dvec3 Light::of(const Surface& surface, const LightRay& ray, double weight, int depth) const {
  const Layer& layer = scene_.layers[surface.face.layer];
  const TriangleSoup& soup = soup_of(layer);
  const bool mirror = layer.material && is_mirror(*layer.material);
  const bool glass = layer.material && is_glass(*layer.material);
  if (!mirror && !glass) {
    const LightRay own = in_layer(ray, surface.face.layer);
    return color(soup, {std::uint32_t(surface.face.face), surface.b0, surface.b1}, -own.direction,
                 eye_of(own));
  }

  const Corners corners(soup, surface.face.face);
  const glm::dmat3 linear(layer.world_from_layer);
  const double b2 = 1 - surface.b0 - surface.b1;
  const glm::dvec3 point =
      glm::dvec3(layer.world_from_layer *
                 glm::dvec4(surface.b0 * corners.a + surface.b1 * corners.b + b2 * corners.c, 1.0));
  glm::dvec3 outward =
      glm::normalize(linear * glm::cross(corners.b - corners.a, corners.c - corners.a));
  glm::dvec3 normal = outward;
  if (!soup.normals.empty()) {
    const glm::uvec3& t = soup.triangles[surface.face.face];
    const glm::dvec3 mean = surface.b0 * glm::dvec3(soup.normals[t[0]]) +
                            surface.b1 * glm::dvec3(soup.normals[t[1]]) +
                            b2 * glm::dvec3(soup.normals[t[2]]);
    if (glm::length(mean) > 1e-6) normal = glm::normalize(linear * mean);
    if (glm::dot(normal, outward) < 0) normal = -normal;
  }
  const bool enters = glm::dot(outward, ray.direction) < 0;
  if (!enters) outward = -outward, normal = -normal;
  if (glm::dot(normal, ray.direction) >= 0) normal = outward;

  const double ior = glass ? double(layer.material->ior) : 1.0;
  const double n1 = enters ? 1.0 : ior, n2 = enters ? ior : 1.0;
  const glm::dvec3 tint(layer.material->base_color);
  const double brightest = std::max({tint.r, tint.g, tint.b});
  glm::dvec3 reflected, refracted;
  double part = 1;
  const auto turn = [&](const glm::dvec3& n) {
    reflected = glm::reflect(ray.direction, n);
    refracted = glm::dvec3(0);
    part = 1;
    if (mirror) return glm::dot(reflected, outward) > 0;
    const double sine_in = std::min(glm::length(glm::cross(ray.direction, n)), 1.0);
    const double sine_out = sine_in * n1 / n2;
    if (sine_out < 1) {
      part = reflected_part(sine_in, sine_out, n1, n2);
      refracted = glm::refract(ray.direction, n, n1 / n2);
    }
    return glm::dot(reflected, outward) > 0 && glm::dot(refracted, outward) <= 0;
  };
  if (!turn(normal)) turn(outward);
  const auto next = [&](const glm::dvec3& direction, double counts) {
    const LightRay there{point, glm::normalize(direction), ray.path + surface.distance, ray.pixel};
    return along(there, surface.face, counts, depth + 1);
  };
  if (mirror) return tint * next(reflected, weight * brightest);
  glm::dvec3 sum = part * next(reflected, weight * part);
  if (part < 1) sum += (1 - part) * tint * next(refracted, weight * (1 - part) * brightest);
  return sum;
}

ImageF Light::image(const FrameInput& input) const {
  const Camera& camera = input.camera;
  std::vector<PlacedLayer> splats;
  std::vector<LayerPlace> places;
  for (const PlacedLayer& layer : placed_layers(scene_)) {
    if (!layer.place.visible) continue;
    places.push_back({bounds(layer), layer.place.world_from_layer});
    if (layer.splats) splats.push_back(layer);
  }
  const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
  std::vector<LightRay> rays;
  std::vector<Surface> surfaces;
  std::vector<double> depths;
  for (std::size_t i = 0; i < pixels; ++i) {
    const glm::dvec3 view((double(i % std::size_t(camera.width)) + 0.5 - camera.cx) / camera.fx,
                          (camera.cy - double(i / std::size_t(camera.width)) - 0.5) / camera.fy,
                          -1);
    rays.push_back({camera.eye(), camera.world_from_view_rotation() * glm::normalize(view), 0,
                    1 / std::sqrt(camera.fx * camera.fy)});
    surfaces.push_back(nearest(rays.back(), {~std::size_t(0), 0}));
    depths.push_back(surfaces.back().distance / glm::length(view));
  }
  std::vector<BlendedSample> blended(pixels);
  if (!splats.empty())
    blended = blend(splats, camera, depths,
                    {.order = SplatOrder::exact,
                     .near = clip_range(places, camera, DepthStorage::reversed_float).near,
                     .whole = input.whole});
  ImageF image(camera.width, camera.height);
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool is_open = surfaces[i].face.layer == ~std::size_t(0);
    const double through = blended[i].transmittance;
    const glm::dvec3 behind = is_open ? background_ : of(surfaces[i], rays[i], through, 0);
    image.pixels[i] = glm::vec4(glm::clamp(blended[i].color + through * behind, 0.0, 1.0), 1.0);
  }
  return image;
}

}  // namespace tureen::oracle
