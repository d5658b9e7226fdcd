#include "oracle/published_culls.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tureen::oracle {

namespace {

constexpr double tile_size = 16;

double first_tile(double begin) { return tile_size * std::floor(begin / tile_size); }
double end_of_tiles(double end) {
  return tile_size * std::floor((end + tile_size - 1) / tile_size);
}

ImageBox tiles_around(const glm::dvec2& center, double radius) {
  return {{first_tile(center.x - radius), first_tile(center.y - radius)},
          {end_of_tiles(center.x + radius), end_of_tiles(center.y + radius)}};
}

}  // namespace

bool is_published_window(const SplatView& view, const std::array<glm::dvec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const glm::dvec3 center = (a + b + c) / 3.0;
  const double cosine = glm::dot(glm::normalize(glm::cross(b - a, c - a)), glm::normalize(center));
  if (!(std::abs(cosine) >= 1e-3)) return false;
  const glm::dvec2 p = view.image(a), q = view.image(b), r = view.image(c);
  const glm::dvec2 middle = view.image(center);
  const double farthest =
      std::max({glm::distance(p, middle), glm::distance(q, middle), glm::distance(r, middle)});
  if (!(farthest >= 1 && farthest <= 1600)) return false;
  const double perimeter = glm::distance(p, q) + glm::distance(q, r) + glm::distance(r, p);
  const double doubled_area = std::abs((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
  return doubled_area >= perimeter;  // the inradius is their quotient
}

ImageBox published_tiles_of_gaussian(const glm::dvec2& center, double xx, double xy, double yy) {
  const double middle = (xx + yy) / 2;
  const double squared_difference = (xx - yy) * (xx - yy) / 4 + xy * xy;
  const double largest = middle + std::sqrt(std::max(0.1, squared_difference));
  // The code has the centre of its first pixel at 0.
  return tiles_around(center - 0.5, std::ceil(3 * std::sqrt(largest)));
}

ImageBox published_tiles_of_disc(const SplatView& view, const glm::dvec3& center,
                                 const glm::dvec3& u_axis, const glm::dvec3& v_axis) {
  // compute_aabb() of its rasteriser: rows of the map from (u, v, 1) to homogeneous pixels.
  const Camera& camera = view.camera();
  const glm::dvec3 z(u_axis.z, v_axis.z, center.z);
  const glm::dvec3 x = camera.fx * glm::dvec3(u_axis.x, v_axis.x, center.x) + camera.cx * z;
  const glm::dvec3 y = camera.fy * glm::dvec3(u_axis.y, v_axis.y, center.y) + camera.cy * z;
  const glm::dvec3 cutoff(9, 9, -1);
  const double d = glm::dot(cutoff, z * z);
  const glm::dvec2 middle = glm::dvec2(glm::dot(cutoff, x * z), glm::dot(cutoff, y * z)) / d;
  const glm::dvec2 squared =
      middle * middle - glm::dvec2(glm::dot(cutoff, x * x), glm::dot(cutoff, y * y)) / d;
  double extent = 3 * std::sqrt(0.5);
  for (int axis = 0; axis < 2; ++axis)
    extent = std::max(extent, std::sqrt(std::max(1e-4, squared[axis])));
  return tiles_around(middle, std::ceil(extent));
}

bool contains(const ImageBox& tiles, const glm::dvec2& pixel) {
  return pixel.x > tiles.low.x && pixel.x < tiles.high.x && pixel.y > tiles.low.y &&
         pixel.y < tiles.high.y;
}

}  // namespace tureen::oracle
