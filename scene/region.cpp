#include "scene/region.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "base/error.hpp"
#include "scene/clip_range.hpp"
#include "scene/upper_median.hpp"

namespace tureen {

namespace {

/// Axes meet if the mean of sin^2 of the angles to their mean axis is at least this (3 degrees).
/// Below it, pose errors determine the distance of the meeting point.
constexpr double min_spread = 3e-3;

/// Distances below this fraction of the eyes' coordinates are rounding errors of poses in floats.
constexpr double rounding = 1e-6;

/// The c with the smallest sum of weight * |(I - d d^T)(c - eye)|^2, if the axes (eye, d) determine
/// it. `weight_of(view)`: their sum is 1.
template <class Weight>
std::optional<glm::dvec3> nearest_to_axes(std::span<const Camera> views, const Weight& weight_of) {
  glm::dmat3 normal(0.0);
  glm::dvec3 right(0.0);
  for (const Camera& view : views) {
    const glm::dvec3 d = forward_of(view);
    const glm::dmat3 across = weight_of(view) * (glm::dmat3(1.0) - glm::outerProduct(d, d));
    normal += across;
    right += across * view.eye();
  }
  const glm::dmat3 inverse = glm::inverse(normal);
  double squares = 0;
  for (int column = 0; column < 3; ++column) squares += glm::dot(inverse[column], inverse[column]);
  // The norm of the inverse is one over the smallest eigenvalue, within a factor of sqrt(3). NaN
  // and infinity (a singular matrix) fail the comparison.
  if (!(std::sqrt(squares) < 1 / min_spread)) return std::nullopt;
  return inverse * right;
}

std::optional<glm::dvec3> nearest_to_axes(std::span<const Camera> views) {
  return nearest_to_axes(views, [&](const Camera&) { return 1.0 / double(views.size()); });
}

/// The tangent of half the angle that the smaller side of the image covers.
double half_tangent(const Camera& camera) {
  return std::min(0.5 * camera.width / camera.fx, 0.5 * camera.height / camera.fy);
}

/// The region around a centre that most cameras look at; nothing if it is behind most cameras.
std::optional<Region> looked_at(std::span<const Camera> views, glm::dvec3 center) {
  std::vector<double> half_sides;
  for (const Camera& camera : views) {
    const double depth = glm::dot(center - camera.eye(), forward_of(camera));
    if (depth > rounding * glm::length(camera.eye()))
      half_sides.push_back(depth * half_tangent(camera));
  }
  if (2 * half_sides.size() <= views.size()) return std::nullopt;
  return Region{center, upper_median(half_sides)};
}

Region of_points(const std::vector<DatasetPoint>& points) {
  Region region;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const DatasetPoint& point : points) values.push_back(point.position[axis]);
    region.center[axis] = upper_median(std::move(values));
  }
  std::vector<double> distances;
  for (const DatasetPoint& point : points)
    distances.push_back(glm::distance(point.position, region.center));
  region.half_side = upper_median(std::move(distances));
  return region;
}

Region of_eyes(std::span<const Camera> views, bool outwards) {
  glm::dvec3 middle(0.0), direction(0.0);
  for (const Camera& view : views) {
    middle += view.eye() / double(views.size());
    direction += forward_of(view) / double(views.size());
  }
  double extent = 0;
  for (const Camera& view : views) extent = std::max(extent, glm::distance(view.eye(), middle));
  const bool coincide = extent <= rounding * glm::length(middle);
  // Axes of opposite directions have no mean direction: these cameras look outwards, too.
  const Region around{middle, coincide ? 1 : 2 * extent};
  if (outwards || glm::length(direction) < rounding) return around;
  const glm::dvec3 ahead = glm::normalize(direction);
  if (!coincide) return looked_at(views, middle + 8 * extent * ahead).value_or(around);
  std::vector<double> half_tangents;
  for (const Camera& view : views) half_tangents.push_back(half_tangent(view));
  return {middle + ahead / upper_median(std::move(half_tangents)), 1};
}

}  // namespace

std::optional<Region> region_of_cameras(std::span<const Camera> cameras) {
  if (cameras.empty()) return std::nullopt;
  const std::optional<glm::dvec3> center = nearest_to_axes(cameras);
  std::optional<Region> region = center ? looked_at(cameras, *center) : std::nullopt;
  if (!region) region = of_eyes(cameras, center.has_value());
  return region->half_side > 0 && std::isfinite(region->half_side) ? region : std::nullopt;
}

std::optional<glm::dvec3> looked_at_point(std::span<const Camera> cameras) {
  if (cameras.empty()) return std::nullopt;
  std::optional<glm::dvec3> point = nearest_to_axes(cameras);
  // Nearer to an axis, the weight of a camera does not grow: the angle, about half a degree, is the
  // error of a pose, and some point of an axis is always the best of all for its camera.
  constexpr double smallest_angle = 0.01;
  const auto weight = [&](const Camera& camera) {
    const glm::dvec3 sight = *point - camera.eye(), forward = forward_of(camera);
    const double depth = glm::dot(sight, forward);
    if (!(depth > 0)) return 0.0;
    return 1 / std::max(glm::distance(sight, depth * forward), smallest_angle * depth);
  };
  constexpr int rounds = 10;
  for (int i = 0; i < rounds && point; ++i) {
    double sum = 0;
    for (const Camera& camera : cameras) sum += weight(camera);
    if (!(sum > 0) || !std::isfinite(sum)) return std::nullopt;
    point = nearest_to_axes(cameras, [&](const Camera& camera) { return weight(camera) / sum; });
  }
  if (!point) return std::nullopt;
  const auto in_front = std::count_if(cameras.begin(), cameras.end(),
                                      [&](const Camera& camera) { return weight(camera) > 0; });
  return 2 * std::size_t(in_front) > cameras.size() ? point : std::nullopt;
}

Region region_of_interest(const Dataset& dataset) {
  if (dataset.train.empty()) throw InputError({}, "the dataset has no training views");
  std::vector<Camera> cameras;
  for (const Photograph& view : dataset.train) cameras.push_back(view.camera);
  const std::optional<glm::dvec3> center = nearest_to_axes(cameras);
  if (center)
    if (const std::optional<Region> region = looked_at(cameras, *center)) return *region;
  Region region;
  region.half_side = 0;
  if (!dataset.points.empty()) region = of_points(dataset.points);
  if (!(region.half_side > 0)) region = of_eyes(cameras, center.has_value());
  // Squares of the coordinates may overflow.
  if (!(region.half_side > 0) || !std::isfinite(region.half_side))
    throw InputError({}, "the positions of the cameras give no finite size of the scene");
  return region;
}

}  // namespace tureen
