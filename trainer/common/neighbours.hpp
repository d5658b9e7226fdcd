// Points and the distances between them, for choosing where triangles begin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tureen::trainer {

/// The distance of every point to the nearest other one; of coincident points 0, of a single one
/// 0. O(n log n).
std::vector<double> nearest_distances(std::span<const glm::dvec3> points);

/// Indices of `count` points (at most all), each the farthest from those before it (Gonzalez 1985),
/// beginning with `first`. Of equally far ones the first. O(points x count).
std::vector<std::uint32_t> farthest_points(std::span<const glm::dvec3> points, std::size_t count,
                                           std::uint32_t first);

}  // namespace tureen::trainer
