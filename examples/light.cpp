#include "examples/light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "examples/shapes.hpp"

namespace tureen::example {
namespace {

using std::numbers::pi;

const glm::dvec3 window_direction = glm::normalize(glm::dvec3(-0.62, 0.74, 0.36));
constexpr double window_angle = 0.17;  // of the cone, radians
const glm::dvec3 window_irradiance(2.15, 1.93, 1.62);

// Rays start at this offset above a surface. The facets of concave parts lie above the true surface
// by up to 0.012 (a chord of 0.12 on the bend of the shoulder, radius 0.15).
constexpr double offset = 0.022, nearest = 0.002;

/// A Fibonacci lattice on the sphere, turned so that no sample lies in the table's plane.
std::vector<glm::dvec3> over_the_sphere(int count) {
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2.0 * i + 1) / count, r = std::sqrt(1 - y * y);
    const double angle = 2 * pi * i / std::numbers::phi;
    directions.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
  }
  return directions;
}

std::vector<glm::dvec3> over_the_window(int count) {
  std::vector<glm::dvec3> directions;
  const glm::dmat3 frame = frame_along(window_direction);
  for (int i = 0; i < count; ++i) {
    const double r = std::tan(window_angle) * std::sqrt((i + 0.5) / count);
    const double angle = 2 * pi * i / std::numbers::phi;
    directions.push_back(
        glm::normalize(frame * glm::dvec3(r * std::cos(angle), 1, r * std::sin(angle))));
  }
  return directions;
}

glm::dvec3 sky(glm::dvec3 d) {
  const glm::dvec3 zenith(0.60, 0.68, 0.80), horizon(0.66, 0.64, 0.60), floor(0.30, 0.26, 0.22);
  const glm::dvec3 above = glm::mix(horizon, zenith, glm::smoothstep(0.0, 0.9, d.y));
  // Brighter on the window's side.
  const double side = 1 + 0.45 * glm::dot(d, glm::dvec3(-0.8, 0, 0.6));
  return glm::mix(floor, above * side, glm::smoothstep(-0.25, 0.05, d.y));
}

}  // namespace

glm::dvec3 room_radiance(glm::dvec3 d) {
  // In a glaze, the window is a soft spot, as wide as the cone of window_angle.
  const double angle = std::acos(std::clamp(glm::dot(d, window_direction), -1.0, 1.0));
  const double spot = std::exp(-0.5 * std::pow(angle / 0.15, 2.0));
  return sky(d) + spot * glm::dvec3(22.0, 20.7, 18.8);
}

Light::Light(const Model& model, const RayCaster& caster, const LightQuality& quality)
    : model_(model),
      caster_(caster),
      sky_directions_(over_the_sphere(quality.sky_rays)),
      window_directions_(over_the_window(quality.window_rays)),
      face_radiance_(model.faces.size(), glm::dvec3(0)) {
  for (int bounce = 0; bounce < 2; ++bounce) {
    std::vector<glm::dvec3> next(model.faces.size());
    for (std::size_t i = 0; i < model.faces.size(); ++i) {
      const Face& face = model.faces[i];
      const SurfacePoint at =
          model.point(face.surface, (face.uv[0] + face.uv[1] + face.uv[2]) / 3.0);
      next[i] = model.paint(at, face.surface).albedo * falling(face.surface, at);
    }
    face_radiance_ = std::move(next);
  }
}

glm::dvec3 Light::gather(glm::dvec3 position, glm::dvec3 normal) const {
  const glm::dvec3 origin = position + offset * normal;
  glm::dvec3 from_sky(0), from_window(0);
  for (const glm::dvec3& direction : sky_directions_) {
    const double cosine = glm::dot(direction, normal);
    if (cosine <= 0) continue;
    const auto hit = caster_.first_hit(origin, direction, nearest);
    from_sky += cosine * (hit ? face_radiance_[hit->face] : sky(direction));
  }
  for (const glm::dvec3& direction : window_directions_) {
    const double cosine = glm::dot(direction, normal);
    if (cosine > 0 && !caster_.first_hit(origin, direction, nearest))
      from_window += cosine * window_irradiance;
  }
  return from_sky * (4.0 / double(sky_directions_.size())) +
         from_window / (pi * double(window_directions_.size()));
}

glm::dvec3 Light::falling(std::uint32_t surface, const SurfacePoint& at) const {
  const double through = model_.surfaces[surface].translucency;
  const glm::dvec3 front = gather(at.position, at.normal);
  if (through == 0) return front;
  return glm::mix(front, gather(at.position, -at.normal) * glm::dvec3(1.15, 1.1, 0.6), through);
}

glm::dvec3 Light::mirrored(const SurfacePoint& at, glm::dvec3 direction) const {
  const auto hit = caster_.first_hit(at.position + offset * at.normal, direction, nearest);
  return hit ? face_radiance_[hit->face] : room_radiance(direction);
}

glm::dvec3 displayed(glm::dvec3 radiance) {
  glm::dvec3 out;
  for (int i = 0; i < 3; ++i) {
    constexpr double shoulder = 0.62;
    double x = std::max(0.0, radiance[i] * 0.92);
    if (x > shoulder)
      x = shoulder + (1 - shoulder) * (1 - std::exp(-(x - shoulder) / (1 - shoulder)));
    out[i] = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  }
  return out;
}

}  // namespace tureen::example
