#include "trainer/common/neighbours.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace tureen::trainer {

namespace {

/// The interface that nanoflann needs for a point cloud.
struct Cloud {
  std::span<const glm::dvec3> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][glm::length_t(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;  // nanoflann then computes the box itself
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud,
                                                 3, std::size_t>;

}  // namespace

std::vector<double> nearest_distances(std::span<const glm::dvec3> points, std::size_t neighbours) {
  std::vector<double> distances(points.size(), 0.0);
  neighbours = std::min(neighbours, points.size() - 1);
  if (points.size() < 2) return distances;
  const Cloud cloud{points};
  const Tree tree(3, cloud);
  std::vector<std::size_t> nearest(neighbours + 1);
  std::vector<double> squares(neighbours + 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.knnSearch(&points[i][0], neighbours + 1, nearest.data(), squares.data());
    // The first is the point itself, or a coincident one.
    for (std::size_t k = 1; k <= neighbours; ++k)
      distances[i] += std::sqrt(squares[k]) / double(neighbours);
  }
  return distances;
}

std::vector<std::uint32_t> nearest_points(std::span<const glm::dvec3> points,
                                          std::span<const glm::dvec3> places) {
  assert(!points.empty());
  const Cloud cloud{points};
  const Tree tree(3, cloud);
  std::vector<std::uint32_t> nearest;
  nearest.reserve(places.size());
  for (const glm::dvec3& place : places) {
    std::size_t index = 0;
    double square = 0;
    tree.knnSearch(&place[0], 1, &index, &square);
    nearest.push_back(std::uint32_t(index));
  }
  return nearest;
}

std::vector<std::uint32_t> farthest_points(std::span<const glm::dvec3> points, std::size_t count,
                                           std::uint32_t first) {
  assert(points.empty() || first < points.size());
  count = std::min(count, points.size());
  std::vector<std::uint32_t> chosen;
  // One array per coordinate, in floats relative to the first point, so that the loop vectorises.
  std::vector<float> x, y, z;
  for (const glm::dvec3& point : points) {
    const glm::vec3 relative(point - points[first]);
    x.push_back(relative.x), y.push_back(relative.y), z.push_back(relative.z);
  }
  std::vector<float> squares(points.size(), std::numeric_limits<float>::infinity());
  std::size_t next = first;
  while (chosen.size() < count) {
    chosen.push_back(std::uint32_t(next));
    const float at_x = x[next], at_y = y[next], at_z = z[next];
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const float dx = x[i] - at_x, dy = y[i] - at_y, dz = z[i] - at_z;
      squares[i] = std::min(squares[i], dx * dx + dy * dy + dz * dz);
    }
    squares[next] = -1.0f;  // excludes it, even if all remaining points coincide with it
    next = std::size_t(std::ranges::max_element(squares) - squares.begin());
  }
  return chosen;
}

}  // namespace tureen::trainer
