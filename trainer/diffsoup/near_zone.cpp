#include "trainer/diffsoup/near_zone.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "trainer/common/homogeneous_pixels.hpp"

namespace tureen::trainer {

namespace {

/// The pyramid between an eye and a rectangle parallel to its image.
class NearPyramid {
 public:
  NearPyramid(const Camera& camera, glm::dvec3 origin, double near)
      : pixels_(camera, origin), near_(near) {}

  bool meets(const glm::vec3* corners) const {
    std::array<glm::dvec3, max_corners> polygon, clipped;
    std::size_t count = 3;
    for (std::size_t i = 0; i < 3; ++i) polygon[i] = pixels_(corners[i]);
    for (int plane = 0; plane < planes; ++plane) {
      std::size_t left = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 a = polygon[i], b = polygon[(i + 1) % count];
        const double at_a = distance(plane, a), at_b = distance(plane, b);
        if (at_a >= 0) clipped[left++] = a;
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0))
          clipped[left++] = a + at_a / (at_a - at_b) * (b - a);
      }
      if (left == 0) return false;
      std::swap(polygon, clipped);
      count = left;
    }
    return true;
  }

 private:
  static constexpr int planes = 1 + HomogeneousPixels::sides;
  /// A convex polygon gains one corner at a plane. Rounding may make a polygon concave if it is as
  /// small as the rounding error, for example at the eye. Then every second corner may be outside,
  /// and the number of corners grows by one half: from 3 to 4, 6, 9, 13 and 19.
  static constexpr std::size_t max_corners = 19;

  /// At least 0 on the inner side. Plane 0, the near plane, excludes most triangles.
  double distance(int plane, glm::dvec3 point) const {
    return plane == 0 ? near_ - point.z : pixels_.from_side(plane - 1, point);
  }

  HomogeneousPixels pixels_;
  double near_;
};

/// Distance in front of the camera's plane, for any point.
double depth(const Camera& camera, glm::dvec3 point) {
  return -(camera.view_from_world * glm::dvec4(point, 1.0)).z;
}

double quantile(std::vector<double>& values, double fraction) {
  const auto at = values.begin() + std::ptrdiff_t(fraction * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The distance from the cameras to the nearest surface, estimated from the dataset; 0 if unknown.
double nearest_surface(const Dataset& dataset, const Region& region) {
  std::vector<double> depths;
  for (const Photograph& view : dataset.train)
    for (const DatasetPoint& point : dataset.points)
      if (in_image(view.camera, point.position))
        depths.push_back(depth(view.camera, point.position));
  // Some points from structure from motion are errors, often right in front of a camera.
  if (!depths.empty()) return quantile(depths, 0.01);
  for (const Photograph& view : dataset.train)
    if (const double d = depth(view.camera, region.center); d > 0) depths.push_back(d);
  return 2 * depths.size() > dataset.train.size() ? quantile(depths, 0.5) : 0;
}

}  // namespace

Config with_empty_near_zone(const Config& config, const Dataset& dataset, const Region& region) {
  Config fitted = config;
  if (!config.clear_near) return fitted;
  const double nearest = nearest_surface(dataset, region);
  const double least = published(Preset::scene).near * region.half_side / reference_extent;
  if (!(nearest > 0)) fitted.clear_near = false;
  fitted.near = float(std::min(double(config.near), std::max(0.5 * nearest, least)));
  return fitted;
}

std::vector<std::uint8_t> reaching_near_zone(const Model& model, std::span<const Camera> cameras,
                                             double near) {
  assert(near > 0);
  std::vector<std::uint8_t> reaching(model.faces(), 0);
  for (const Camera& camera : cameras) {
    const NearPyramid pyramid(camera, model.origin, near);
    for (std::size_t face = 0; face < model.faces(); ++face)
      if (!reaching[face]) reaching[face] = pyramid.meets(&model.positions[3 * face]);
  }
  return reaching;
}

}  // namespace tureen::trainer
