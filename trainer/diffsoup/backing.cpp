#include "trainer/diffsoup/backing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

namespace tureen::trainer {

namespace {

using Triangle = std::array<glm::dvec3, 3>;

/// Corners of length 1.
std::vector<Triangle> icosahedron() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<glm::dvec3> corners;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-golden, golden}) {
      corners.emplace_back(0, a, b);
      corners.emplace_back(a, b, 0);
      corners.emplace_back(b, 0, a);
    }
  // Its faces are the triples of neighbours; neighbours are at a distance of 2.
  const auto are_neighbours = [&](std::size_t i, std::size_t j) {
    return glm::distance(corners[i], corners[j]) < 2.1;
  };
  std::vector<Triangle> faces;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j)
      for (std::size_t k = j + 1; k < corners.size(); ++k)
        if (are_neighbours(i, j) && are_neighbours(j, k) && are_neighbours(i, k))
          faces.push_back(
              {glm::normalize(corners[i]), glm::normalize(corners[j]), glm::normalize(corners[k])});
  return faces;
}

std::vector<Triangle> subdivided(const std::vector<Triangle>& faces) {
  std::vector<Triangle> result;
  for (const auto& [a, b, c] : faces) {
    const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                     ca = glm::normalize(c + a);
    for (const Triangle& part :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
      result.push_back(part);
  }
  return result;
}

/// Cameras farther than this multiple of the distance that 90 % do not exceed are errors of
/// structure from motion: they see the sphere from outside.
constexpr double outlier = 4;

/// The distance of the farthest camera from the region's centre, without outliers.
double farthest_camera(const Dataset& dataset, const Region& region) {
  std::vector<double> distances;
  for (const Photograph& view : dataset.train)
    distances.push_back(glm::distance(view.camera.eye(), region.center));
  if (distances.empty()) return 0;
  std::ranges::sort(distances);
  const double most = outlier * distances[distances.size() * 9 / 10];
  return *std::prev(std::upper_bound(distances.begin(), distances.end(), most));
}

/// The middle of a large triangle is nearer to the centre than its corners: with 20 triangles, at
/// 0.79 of the radius. Surfaces and cameras stay clear of it by this factor.
constexpr double clearance = 1.5;

}  // namespace

std::size_t backing_faces(const Config& config) {
  if (config.initialisation == Initialisation::mesh) return 0;
  // More would take from the budget what the surfaces need.
  const int most = std::min(config.backing_triangles, config.triangles / 100);
  std::size_t faces = 20;
  if (most < int(faces)) return 0;
  while (4 * faces <= std::size_t(most)) faces *= 4;
  return faces;
}

double min_backing_radius(const Config& config, const Dataset& dataset, const Region& region) {
  const double half_side = std::max(region.half_side, double(config.box));
  return clearance * std::max(config.far_extent * half_side, farthest_camera(dataset, region));
}

Config with_visible_backing(const Config& config, const Dataset& dataset, const Region& region) {
  Config result = config;
  if (backing_faces(config) == 0) return result;
  const double needed =
      min_backing_radius(config, dataset, region) + farthest_camera(dataset, region);
  result.far = std::max(config.far, float(1.01 * needed));  // the factor covers rounding
  return result;
}

double backing_radius(const Config& config, const Dataset& dataset, const Region& region,
                      std::span<const glm::dvec3> centers) {
  double radius = min_backing_radius(config, dataset, region);
  for (const glm::dvec3& center : centers)
    radius = std::max(radius, clearance * glm::distance(center, region.center));
  return std::min(radius, config.far / 1.01 - farthest_camera(dataset, region));
}

std::vector<glm::vec3> backing_sphere(std::size_t faces, double radius) {
  std::vector<glm::vec3> corners;
  if (faces == 0) return corners;
  std::vector<Triangle> triangles = icosahedron();
  while (triangles.size() < faces) triangles = subdivided(triangles);
  for (const Triangle& triangle : triangles)
    for (const glm::dvec3& corner : triangle) corners.emplace_back(radius * corner);
  return corners;
}

}  // namespace tureen::trainer
