#include "camera/camera_sets.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <numbers>

#include "base/error.hpp"

namespace tureen {

namespace {

using std::numbers::pi;
constexpr double golden_angle = 2.39996322972865332;  // pi (3 - sqrt 5)

/// Directions of the Fibonacci lattice between two heights (sines of the elevation).
std::vector<Bearing> fibonacci_bearings(int count, double lowest, double highest) {
  std::vector<Bearing> bearings;
  for (int i = 0; i < count; ++i) {
    const double height = lowest + (highest - lowest) * (i + 0.5) / count;
    bearings.push_back({std::fmod(i * golden_angle, 2 * pi), std::asin(height)});
  }
  return bearings;
}

glm::dvec3 up_of(const Subject& subject) {
  return glm::length(subject.up) > 0 ? glm::normalize(subject.up) : glm::dvec3(0, 1, 0);
}

Camera looking_at_center(const Subject& subject, const Bearing& bearing, const Lens& lens,
                         double distance) {
  return look_at(subject.center() + distance * direction_of(subject.up, bearing), subject.center(),
                 up_of(subject), lens.fov_y, lens.width, lens.height);
}

/// The n of "every n-th face", which limits the time for large scenes.
std::size_t stride_of(const TriangleSoup& soup) {
  constexpr std::size_t enough = 200'000;
  return std::max<std::size_t>(1, (soup.triangles.size() + enough - 1) / enough);
}

using Corners = std::array<glm::dvec3, 3>;

Corners corners_of(const TriangleSoup& soup, std::size_t face, const glm::dvec3& origin) {
  const glm::uvec3& t = soup.triangles[face];
  return {origin + glm::dvec3(soup.positions[t.x]), origin + glm::dvec3(soup.positions[t.y]),
          origin + glm::dvec3(soup.positions[t.z])};
}

glm::dvec3 area_vector(const Corners& p) { return 0.5 * glm::cross(p[1] - p[0], p[2] - p[0]); }

bool is_finite(const Corners& p) {
  return std::isfinite(glm::dot(p[0], p[0]) + glm::dot(p[1], p[1]) + glm::dot(p[2], p[2]));
}

// The grid of estimated_overdraw. It is coarse, since it only compares views.
constexpr int columns = 64, rows = 36;

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// The number of grid cells whose centre lies in the triangle `p`. Unit of `p`: cells.
int covered_cells(const std::array<glm::dvec2, 3>& p, double area) {
  const auto [low_x, high_x] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [low_y, high_y] = std::minmax({p[0].y, p[1].y, p[2].y});
  const double side = area < 0 ? -1 : 1;
  int count = 0;
  for (int y = int(std::max(0.0, low_y)); y <= int(std::min(rows - 1.0, high_y)); ++y)
    for (int x = int(std::max(0.0, low_x)); x <= int(std::min(columns - 1.0, high_x)); ++x) {
      const glm::dvec2 c(x + 0.5, y + 0.5);
      count += side * cross(p[1] - p[0], c - p[0]) >= 0 &&
               side * cross(p[2] - p[1], c - p[1]) >= 0 && side * cross(p[0] - p[2], c - p[2]) >= 0;
    }
  return count;
}

/// The covered part of the image, in cells.
double cells_of(const Corners& world, const Camera& camera) {
  std::array<glm::dvec2, 3> p;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 view(camera.view_from_world * glm::dvec4(world[std::size_t(k)], 1.0));
    // A face that extends behind the eye counts as 0. This is sufficient to compare views.
    if (!(view.z < 0)) return 0;
    const double x = camera.cx - camera.fx * view.x / view.z;
    const double y = camera.cy + camera.fy * view.y / view.z;
    p[std::size_t(k)] = {x * columns / camera.width, y * rows / camera.height};
  }
  const double area = 0.5 * cross(p[1] - p[0], p[2] - p[0]);
  if (std::abs(area) >= 1) return covered_cells(p, area);
  const glm::dvec2 center = (p[0] + p[1] + p[2]) / 3.0;
  const bool inside = center.x >= 0 && center.x < columns && center.y >= 0 && center.y < rows;
  return inside ? std::abs(area) : 0;
}

/// The centre of mass of all faces, or the centre of the box if they have no area.
glm::dvec3 center_of_mass(const TriangleSoup& soup, const glm::dvec3& origin,
                          const Subject& subject) {
  glm::dvec3 sum(0);
  double weight = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); t += stride_of(soup)) {
    const Corners p = corners_of(soup, t, origin);
    if (!is_finite(p)) continue;
    const double area = glm::length(area_vector(p));
    // Relative to the box's centre, since the sum would lose digits far from the world's origin.
    sum += area * ((p[0] + p[1] + p[2]) / 3.0 - subject.center());
    weight += area;
  }
  return weight > 0 ? subject.center() + sum / weight : subject.center();
}

/// The camera with the highest score; the first among equals.
template <class Score>
Camera best_of(const std::vector<Camera>& candidates, Score score) {
  const Camera* best = &candidates.front();
  double highest = -std::numeric_limits<double>::infinity();
  for (const Camera& camera : candidates)
    if (const double value = score(camera); value > highest) {
      highest = value;
      best = &camera;
    }
  return *best;
}

std::vector<Camera> around(const Subject& subject, const std::vector<Bearing>& bearings,
                           const Lens& lens, std::initializer_list<double> distances) {
  std::vector<Camera> cameras;
  for (const Bearing& bearing : bearings)
    for (const double distance : distances)
      cameras.push_back(looking_at_center(subject, bearing, lens,
                                          distance * framing_distance(subject, bearing, lens)));
  return cameras;
}

std::vector<Camera> from_inside(const glm::dvec3& eye, const Subject& subject, const Lens& lens) {
  constexpr int directions = 8;
  std::vector<Camera> cameras;
  for (int i = 0; i < directions; ++i) {
    const glm::dvec3 forward = direction_of(subject.up, {2 * pi * i / directions, 0});
    cameras.push_back(
        look_at(eye, eye + forward, up_of(subject), lens.fov_y, lens.width, lens.height));
  }
  return cameras;
}

Camera named(Camera camera, const char* name) {
  camera.name = name;
  return camera;
}

}  // namespace

std::optional<CameraSetName> parse_camera_set(std::string_view text,
                                              std::initializer_list<std::string_view> kinds) {
  const std::size_t colon = text.find(':');
  CameraSetName set{.kind = std::string(text.substr(0, colon))};
  if (std::find(kinds.begin(), kinds.end(), set.kind) == kinds.end()) return std::nullopt;
  if (colon == std::string_view::npos) return set;
  const std::string_view digits = text.substr(colon + 1);
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), set.count);
  if (error != std::errc() || end != digits.data() + digits.size() || set.count < 1 ||
      set.count > 1000)
    throw UsageError("'" + std::string(text) + "' needs a number of views from 1 to 1000");
  return set;
}

std::vector<Camera> hemisphere(const Subject& subject, int count, const Lens& lens) {
  const std::vector<Bearing> bearings = fibonacci_bearings(count, 0, 1);
  double distance = 0;
  for (const Bearing& bearing : bearings)
    distance = std::max(distance, framing_distance(subject, bearing, lens));
  std::vector<Camera> cameras;
  for (const Bearing& bearing : bearings) {
    cameras.push_back(looking_at_center(subject, bearing, lens, distance));
    cameras.back().name = "hemisphere " + std::to_string(cameras.size() - 1);
  }
  return cameras;
}

double estimated_overdraw(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera) {
  const std::size_t stride = stride_of(soup);
  double cells = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); t += stride)
    if (const Corners p = corners_of(soup, t, origin); is_finite(p)) cells += cells_of(p, camera);
  return cells * double(stride) / (columns * rows);
}

double facing(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera) {
  const glm::dvec3 eye = camera.eye();
  double sum = 0, weight = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); t += stride_of(soup)) {
    const Corners p = corners_of(soup, t, origin);
    const glm::dvec3 area = area_vector(p), sight = (p[0] + p[1] + p[2]) / 3.0 - eye;
    const double distance = glm::length(sight);
    if (!is_finite(p) || !(distance > 0)) continue;
    sum += std::abs(glm::dot(area, sight)) / distance;
    weight += glm::length(area);
  }
  return weight > 0 ? sum / weight : 0;
}

std::vector<Camera> adversarial_views(const TriangleSoup& soup, glm::dvec3 origin,
                                      const Subject& subject, const Lens& lens) {
  const auto overdraw = [&](const Camera& camera) {
    return estimated_overdraw(soup, origin, camera);
  };
  const auto edge_on = [&](const Camera& camera) { return -facing(soup, origin, camera); };
  // Both halves of the sphere, since an eye may also be below the horizon.
  const std::vector<Bearing> many = fibonacci_bearings(64, -1, 1);
  const std::vector<Bearing> few = fibonacci_bearings(24, -1, 1);
  return {
      named(best_of(from_inside(center_of_mass(soup, origin, subject), subject, lens), overdraw),
            "inside"),
      named(around(subject, {three_quarter_view}, lens, {20}).front(), "far"),
      named(best_of(around(subject, many, lens, {1}), edge_on), "grazing"),
      named(best_of(around(subject, few, lens, {1, 0.5, 0.25}), overdraw), "most overdraw")};
}

}  // namespace tureen
