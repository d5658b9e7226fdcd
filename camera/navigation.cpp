#include "camera/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <numbers>
#include <string>

#include "scene/middle_bounds.hpp"
#include "scene/region.hpp"

namespace tureen {

namespace {

using std::numbers::pi;

glm::dvec3 unit_up(const glm::dvec3& up) {
  const double length = glm::length(up);
  return length > 0 ? up / length : glm::dvec3(0, 1, 0);
}

/// The horizontal direction of azimuth 0.
glm::dvec3 front_of(const glm::dvec3& up) {
  // +z if y is up, -y if z is up. For other axes, the one of the two that is nearer to the horizon.
  const glm::dvec3 preferred =
      std::abs(up.z) > std::abs(up.y) ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
  return glm::normalize(preferred - up * glm::dot(up, preferred));
}

Camera camera_at(const Subject& subject, const Bearing& bearing, const Lens& lens,
                 double distance) {
  const glm::dvec3 eye = subject.center() + distance * direction_of(subject.up, bearing);
  return look_at(eye, subject.center(), unit_up(subject.up), lens.fov_y, lens.width, lens.height);
}

struct Box {
  glm::dvec3 low, high;
};

Box in_world(const LayerPlace& placed) {
  const Bounds& box = placed.bounds;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box result{glm::dvec3(infinity), glm::dvec3(-infinity)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 position(corner & 1 ? box.high.x : box.low.x,
                              corner & 2 ? box.high.y : box.low.y,
                              corner & 4 ? box.high.z : box.low.z, 1.0);
    const glm::dvec3 world(placed.world_from_layer * position);
    result.low = glm::min(result.low, world);
    result.high = glm::max(result.high, world);
  }
  return result;
}

bool most_are_inside(const Box& box, std::span<const Camera> cameras) {
  const auto is_inside = [&](const Camera& camera) {
    const glm::dvec3 eye = camera.eye();
    return glm::all(glm::greaterThan(eye, box.low)) && glm::all(glm::lessThan(eye, box.high));
  };
  const auto inside = std::count_if(cameras.begin(), cameras.end(), is_inside);
  return 2 * std::size_t(inside) > cameras.size();
}

/// The part of the box in the region of the cameras, if most cameras are inside the box. Otherwise,
/// or if the region is elsewhere, the whole box.
Box without_surroundings(const Box& box, std::span<const Camera> cameras) {
  if (!most_are_inside(box, cameras)) return box;
  const std::optional<Region> region = region_of_cameras(cameras);
  if (!region) return box;
  const Box part{glm::max(box.low, region->center - region->half_side),
                 glm::min(box.high, region->center + region->half_side)};
  return glm::all(glm::lessThan(part.low, part.high)) ? part : box;
}

}  // namespace

std::vector<LayerPlace> boxes_of(const Scene& scene) {
  std::vector<LayerPlace> boxes;
  for (const Layer& layer : scene.layers)
    boxes.push_back({framed_bounds(layer), layer.world_from_layer});
  return boxes;
}

Subject subject_of(const Scene& scene) {
  return subject_of(boxes_of(scene), glm::dvec3(scene.info.up), scene.cameras);
}

Subject subject_of(std::span<const LayerPlace> boxes, const glm::dvec3& up,
                   std::span<const Camera> cameras) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 low(infinity), high(-infinity);
  for (const LayerPlace& each : boxes) {
    const Box box = without_surroundings(in_world(each), cameras);
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  if (boxes.empty()) low = high = glm::dvec3(0.0);
  return {low, high, up};
}

bool most_are_inside(const LayerPlace& layer, std::span<const Camera> cameras) {
  return most_are_inside(in_world(layer), cameras);
}

glm::dvec3 direction_of(const glm::dvec3& up, const Bearing& bearing) {
  const glm::dvec3 axis = unit_up(up), front = front_of(axis), side = glm::cross(axis, front);
  const glm::dvec3 level = std::cos(bearing.azimuth) * front + std::sin(bearing.azimuth) * side;
  return std::cos(bearing.elevation) * level + std::sin(bearing.elevation) * axis;
}

double framing_distance(const Subject& subject, const Bearing& bearing, const Lens& lens) {
  // The camera's rotation depends neither on its distance nor on the subject's position. Far from
  // the origin, rounding would swallow a distance of 1.
  const Subject at_origin{glm::dvec3(0.0), glm::dvec3(0.0), subject.up};
  const Camera camera = camera_at(at_origin, bearing, lens, 1.0);
  return std::max(1e-6, framing_distance(subject, camera.world_from_view_rotation(), lens));
}

double framing_distance(const Subject& subject, const glm::dmat3& world_from_view,
                        const Lens& lens) {
  constexpr double margin = 1.05;
  const double slope_y = std::tan(0.5 * lens.fov_y) / margin;
  const double slope_x = slope_y * lens.width / lens.height;
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 half = 0.5 * (subject.high - subject.low);
    const glm::dvec3 p =
        half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    // The corner lies z towards the eye; the eye must be at least |x| / slope_x farther.
    const double x = std::abs(glm::dot(p, world_from_view[0]));
    const double y = std::abs(glm::dot(p, world_from_view[1]));
    const double z = glm::dot(p, world_from_view[2]);
    distance = std::max({distance, z + x / slope_x, z + y / slope_y});
  }
  return distance;
}

Camera frame(const Subject& subject, const Bearing& bearing, const Lens& lens) {
  return camera_at(subject, bearing, lens, framing_distance(subject, bearing, lens));
}

std::vector<Camera> orbit(const Subject& subject, int count, const Bearing& start,
                          const Lens& lens) {
  std::vector<Bearing> bearings;
  double distance = 0;
  for (int i = 0; i < count; ++i) {
    bearings.push_back({start.azimuth + 2 * pi * i / count, start.elevation});
    distance = std::max(distance, framing_distance(subject, bearings.back(), lens));
  }
  std::vector<Camera> cameras;
  for (const Bearing& bearing : bearings) {
    cameras.push_back(camera_at(subject, bearing, lens, distance));
    cameras.back().name = "orbit " + std::to_string(cameras.size() - 1);
  }
  return cameras;
}

}  // namespace tureen
